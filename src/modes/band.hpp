// Symmetric matrices of one connected part of a beam, narrow and held on every rank.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace traverse::modes {

/// Lower half of a symmetric band, three codiagonals: the transverse unknowns of a beam (the axial ones need one).
class Band {
 public:
  static constexpr int width = 3;

  explicit Band(int n = 0) : rows_(static_cast<std::size_t>(n)) {}
  int size() const { return static_cast<int>(rows_.size()); }
  /// Entry (i, j), i - width <= j <= i.
  double& at(int i, int j) { return rows_[static_cast<std::size_t>(i)][static_cast<std::size_t>(i - j)]; }
  double at(int i, int j) const { return rows_[static_cast<std::size_t>(i)][static_cast<std::size_t>(i - j)]; }

 private:
  std::vector<std::array<double, width + 1>> rows_;
};

/// How many eigenvalues of K x = lambda M x lie below `sigma`: the negative pivots of K - sigma M = L D L^T
/// (Sylvester's law of inertia).
int count_below(const Band& K, const Band& M, double sigma);

/// The largest K_ii/M_ii: the size of the highest eigenvalues, and times the machine's epsilon that of rounding.
double highest_quotient(const Band& K, const Band& M);

/// An interval (low, high] that holds the lowest of the eigenvalues that are looked for.
struct Bracket {
  double low = 0.0, high = 0.0;
};
/// Narrows a bracket with 0 < low: until it is 5 % wide and holds no more than `most` of them, or it is as narrow as
/// `narrowest`, relatively; then low moves up to the lowest one. below(sigma) says how many of those looked for lie
/// below sigma: none below low.
Bracket narrow(Bracket bracket, int most, double narrowest, const std::function<int(double)>& below);

/// A bracket of the lowest eigenvalue, within a factor of 4; {0, 0} when K is too close to singular to say.
Bracket bracket_lowest(const Band& K, const Band& M);

}  // namespace traverse::modes
