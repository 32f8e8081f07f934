// Symmetric matrices of one connected part of a beam, narrow and stored on every rank.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

namespace traverse::modes {

/// Lower half of a symmetric band with `width` codiagonals: three for the transverse unknowns of a plain beam, one for
/// the axial ones.
class Band {
 public:
  Band() = default;
  Band(int size, int width)
      : size_(size), width_(width), values_(static_cast<std::size_t>(size) * static_cast<std::size_t>(width + 1)) {}
  int size() const { return size_; }
  int width() const { return width_; }
  /// Entry (i, j), i - width <= j <= i.
  double& at(int i, int j) { return values_[place(i, j)]; }
  double at(int i, int j) const { return values_[place(i, j)]; }
  /// Row i, with its diagonal entry: at(i, j) is row(i)[i - j].
  const double* row(int i) const { return &values_[place(i, i)]; }

 private:
  std::size_t place(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(i - j);
  }

  int size_ = 0, width_ = 0;
  std::vector<double> values_;
};

/// y += factor A x.
void add_product(const Band& A, double factor, const double* x, double* y);

/// The number of eigenvalues of K x = lambda M x below `sigma`: the negative pivots of K - sigma M = L D L^T
/// (Sylvester's law of inertia). K and M have the same width.
int count_below(const Band& K, const Band& M, double sigma);

/// K = L D L^T of a positive definite band.
class Factor {
 public:
  explicit Factor(const Band& K);
  /// False if a pivot is not positive: K is singular to rounding.
  bool positive() const { return positive_; }
  /// x becomes K^-1 x.
  void solve(double* x) const;

 private:
  Band rows_;  // rows of L, with the pivots in place of its unit diagonal
  bool positive_ = true;
};

/// The largest K_ii/M_ii: the magnitude of the highest eigenvalues. This value times the machine epsilon is the
/// magnitude of the rounding errors of eigenvalues.
double highest_quotient(const Band& K, const Band& M);

/// An interval (low, high] that contains the lowest of the wanted eigenvalues.
struct Bracket {
  double low = 0.0, high = 0.0;
};
/// Narrows a bracket with 0 < low until it is 5 % wide and contains at most `max_count` eigenvalues, or until its
/// relative width is `min_width`. Then low is moved up close to the lowest eigenvalue. below(sigma) returns the number
/// of wanted eigenvalues below sigma; below(low) is 0.
Bracket narrow(Bracket bracket, int max_count, double min_width, const std::function<int(double)>& below);

/// A bracket of the lowest eigenvalue, within a factor of 4; {0, 0} if K is singular to rounding.
Bracket bracket_lowest(const Band& K, const Band& M);

}  // namespace traverse::modes
