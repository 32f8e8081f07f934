// Column-wise Gaussian elimination with row exchanges within a band of three half-bandwidths, and forward and back
// substitution.
#include "solve/band_lu.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace traverse::solve {

int half_bandwidth(const Eigen::MatrixXd& A) {
  int band = 0;
  const int n = static_cast<int>(A.cols());
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i + band < j; ++i)
      if (A(i, j) != 0.0) band = j - i;
    for (int i = n - 1; i > j + band; --i)
      if (A(i, j) != 0.0) band = i - j;
  }
  return band;
}

void BandLu::compute(const Eigen::MatrixXd& A, int half_bandwidth) {
  set_zero(static_cast<int>(A.cols()), half_bandwidth);
  for (int j = 0; j < size_; ++j) {
    const int first = std::max(0, j - band_), last = std::min(size_ - 1, j + band_);
    for (int i = first; i <= last; ++i) entry(i, j) = A(i, j);
  }
  factor();
}

void BandLu::set_zero(int size, int half_bandwidth) {
  size_ = size;
  band_ = half_bandwidth;
  lu_.setZero(3 * band_ + 1, size_);
  pivot_row_.resize(static_cast<std::size_t>(size_));
  inverse_pivot_.resize(static_cast<std::size_t>(size_));
}

void BandLu::factor() {
  above_ = band_;
  int right = 0;  // last column with entries in the rows so far
  for (int j = 0; j < size_; ++j) {
    const int below = std::min(band_, size_ - 1 - j);
    double* diagonal = &entry(j, j);
    int pivot = 0;
    for (int i = 1; i <= below; ++i)
      if (std::abs(diagonal[i]) > std::abs(diagonal[pivot])) pivot = i;
    pivot_row_[static_cast<std::size_t>(j)] = j + pivot;
    right = std::max(right, std::min(size_ - 1, j + pivot + band_));
    if (pivot != 0) {
      above_ = 2 * band_;
      for (int c = j; c <= right; ++c) std::swap(entry(j, c), entry(j + pivot, c));
    }
    const double inverse = 1.0 / *diagonal;
    inverse_pivot_[static_cast<std::size_t>(j)] = inverse;
    for (int i = 1; i <= below; ++i) diagonal[i] *= inverse;
    for (int c = j + 1; c <= right; ++c) {
      double* column = &entry(j, c);
      const double u = *column;
      if (u == 0.0) continue;
      for (int i = 1; i <= below; ++i) column[i] -= u * diagonal[i];
    }
  }
}

void BandLu::solve_in_place(Eigen::MatrixXd& X) const {
  for (int c = 0; c < X.cols(); ++c) solve_in_place(X.col(c).data());
}

void BandLu::solve_in_place(double* x) const {
  for (int j = 0; j < size_; ++j) {
    std::swap(x[j], x[pivot_row_[static_cast<std::size_t>(j)]]);
    if (x[j] == 0.0) continue;
    const int below = std::min(band_, size_ - 1 - j);
    const double* factors = &lu_(2 * band_, j);
    for (int i = 1; i <= below; ++i) x[j + i] -= factors[i] * x[j];
  }
  for (int j = size_ - 1; j >= 0; --j) {
    x[j] *= inverse_pivot_[static_cast<std::size_t>(j)];
    const int above = std::min(above_, j);
    const double* column = &lu_(2 * band_ - above, j);
    for (int i = 0; i < above; ++i) x[j - above + i] -= column[i] * x[j];
  }
}

}  // namespace traverse::solve
