// Symmetric matrices of one connected part of a beam, narrow and held on every rank.
#pragma once

#include <algorithm>
#include <array>
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

/// An interval (low, high] that holds the lowest eigenvalue of a positive definite K, and few others: at most `most`
/// of them, if that can be had without going below a relative width of 1e-9. {0, 0} when K is too close to
/// singular to say.
struct Bracket {
  double low = 0.0, high = 0.0;
};
Bracket bracket_lowest(const Band& K, const Band& M, int most);

}  // namespace traverse::modes
