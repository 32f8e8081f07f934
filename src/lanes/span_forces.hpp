// The symmetric band matrix of the contacts' Newton iteration (span_crossing.hpp).
#pragma once

#include <algorithm>
#include <vector>

namespace traverse::lanes {

/// A = L D L^T without pivots, positive definite. Columns of the lower half are as long as a whole number of vectors,
/// with as many zeros behind them: all loops go in vectors, whatever the band.
class SpanForces {
 public:
  /// Memory for the most that it may become.
  void reserve(int size) {
    const auto most = static_cast<std::size_t>(size), width = static_cast<std::size_t>(whole(size));
    below_.reserve(2 * (most + width) * width);
    diagonal_.reserve(most + width);
    x_.reserve(most + width);
  }
  void set_zero(int size, int band) {
    size_ = size;
    band_ = std::min(band, std::max(0, size - 1));
    width_ = whole(band_);
    const auto columns = static_cast<std::size_t>(size_ + width_);
    below_.assign(2 * columns * static_cast<std::size_t>(width_), 0.0);
    diagonal_.assign(columns, 0.0);
    x_.assign(columns, 0.0);
  }
  int band() const { return band_; }
  /// Entry (i, j) of the lower half, i - band <= j <= i.
  double& at(int i, int j) { return i == j ? diagonal_[static_cast<std::size_t>(j)] : below(j)[i - j - 1]; }

  void factor() {
    for (int j = 0; j < size_; ++j) {
      double* const column = below(j);
      const double inverse = diagonal_[static_cast<std::size_t>(j)] = 1.0 / diagonal_[static_cast<std::size_t>(j)];
      for (int r = 0; r < band_; ++r) {
        const double scaled = column[r] * inverse;
        diagonal_[static_cast<std::size_t>(j + 1 + r)] -= scaled * column[r];
        double* const to = below(j + 1 + r);
        const double* const from = column + r + 1;
        for (int v = 0; v < width_; v += lane)
          for (int s = 0; s < lane; ++s) to[v + s] -= scaled * from[v + s];
      }
      for (int r = 0; r < width_; ++r) column[r] *= inverse;
    }
  }
  void solve(double* right) {
    double* const x = x_.data();
    std::copy_n(right, size_, x);
    std::fill_n(x + size_, width_, 0.0);
    for (int j = 0; j < size_; ++j) {
      const double* const column = below(j);
      const double known = x[j];
      double* const to = x + j + 1;
      for (int v = 0; v < width_; v += lane)
        for (int s = 0; s < lane; ++s) to[v + s] -= known * column[v + s];
    }
    std::fill_n(x + size_, width_, 0.0);
    for (int j = 0; j < size_; ++j) x[j] *= diagonal_[static_cast<std::size_t>(j)];
    for (int j = size_ - 1; j >= 0; --j) {
      const double* const column = below(j);
      const double* const from = x + j + 1;
      double sums[lane] = {};
      for (int v = 0; v < width_; v += lane)
        for (int s = 0; s < lane; ++s) sums[s] += column[v + s] * from[v + s];
      x[j] -= ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
    }
    std::copy_n(x, size_, right);
  }

 private:
  static constexpr int lane = 8;
  static int whole(int band) { return (band + lane - 1) / lane * lane; }
  double* below(int column) { return below_.data() + 2 * static_cast<std::ptrdiff_t>(column) * width_; }

  int size_ = 0, band_ = 0, width_ = 0;
  std::vector<double> diagonal_, below_, x_;
};

}  // namespace traverse::lanes
