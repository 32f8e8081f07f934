#include "traverse/coupling/band_lu.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace traverse::coupling {

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
  size_ = static_cast<int>(A.cols());
  band_ = half_bandwidth;
  lu_.setZero(3 * band_ + 1, size_);
  pivot_row_.resize(static_cast<std::size_t>(size_));
  for (int j = 0; j < size_; ++j) {
    const int first = std::max(0, j - band_), last = std::min(size_ - 1, j + band_);
    for (int i = first; i <= last; ++i) lu_(2 * band_ + i - j, j) = A(i, j);
  }
  const auto at = [this](int i, int j) -> double& { return lu_(2 * band_ + i - j, j); };
  for (int j = 0; j < size_; ++j) {
    const int below = std::min(band_, size_ - 1 - j);
    int pivot = j;
    for (int i = j + 1; i <= j + below; ++i)
      if (std::abs(at(i, j)) > std::abs(at(pivot, j))) pivot = i;
    pivot_row_[static_cast<std::size_t>(j)] = pivot;
    const int right = std::min(size_ - 1, j + 2 * band_);
    if (pivot != j)
      for (int c = j; c <= right; ++c) std::swap(at(j, c), at(pivot, c));
    auto factors = lu_.col(j).segment(2 * band_ + 1, below);
    factors /= at(j, j);
    for (int c = j + 1; c <= right; ++c)
      if (const double u = at(j, c); u != 0.0) lu_.col(c).segment(2 * band_ + j + 1 - c, below) -= u * factors;
  }
}

void BandLu::solve_in_place(Eigen::MatrixXd& X) const {
  for (int c = 0; c < X.cols(); ++c) {
    double* x = X.col(c).data();
    for (int j = 0; j < size_; ++j) {
      std::swap(x[j], x[pivot_row_[static_cast<std::size_t>(j)]]);
      if (x[j] == 0.0) continue;
      const int below = std::min(band_, size_ - 1 - j);
      for (int i = 1; i <= below; ++i) x[j + i] -= lu_(2 * band_ + i, j) * x[j];
    }
    for (int j = size_ - 1; j >= 0; --j) {
      x[j] /= lu_(2 * band_, j);
      const int above = std::min(2 * band_, j);
      for (int i = 1; i <= above; ++i) x[j - i] -= lu_(2 * band_ - i, j) * x[j];
    }
  }
}

}  // namespace traverse::coupling
