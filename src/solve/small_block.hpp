// Blocks of one node in the factorisation.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "panel.hpp"

namespace traverse::solve {

/// A square matrix of one node's unknowns, column-major; initially zero.
template <int B>
class Block {
 public:
  Block() = default;
  explicit Block(Extent<B> extent) : extent_(extent) {}
  Block(Extent<B> extent, const double* entries) : extent_(extent) { std::copy_n(entries, extent.area(), data()); }

  int size() const { return extent_.size(); }
  double& operator()(int row, int column) { return entries_[index(row, column)]; }
  double operator()(int row, int column) const { return entries_[index(row, column)]; }
  double* data() { return entries_.data(); }
  const double* data() const { return entries_.data(); }

  Block& operator+=(const Block& other) {
    for (std::ptrdiff_t e = 0; e < extent_.area(); ++e) data()[e] += other.data()[e];
    return *this;
  }
  Block& operator-=(const Block& other) {
    for (std::ptrdiff_t e = 0; e < extent_.area(); ++e) data()[e] -= other.data()[e];
    return *this;
  }
  Block operator-() const {
    Block result(extent_);
    result -= *this;
    return result;
  }

  friend Block operator*(const Block& left, const Block& right) {
    Block result(left.extent_);
    const int n = left.size();
    for (int c = 0; c < n; ++c) {
      for (int k = 0; k < n; ++k) {
        for (int r = 0; r < n; ++r) result(r, c) += left(r, k) * right(k, c);
      }
    }
    return result;
  }

  Block transpose() const {
    Block result(extent_);
    for (int c = 0; c < size(); ++c) {
      for (int r = 0; r < size(); ++r) result(r, c) = (*this)(c, r);
    }
    return result;
  }

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(column) * static_cast<std::size_t>(size()) + static_cast<std::size_t>(row);
  }

  Extent<B> extent_;
  std::array<double, static_cast<std::size_t>(storage_block<B>) * storage_block<B>> entries_ = {};
};

}  // namespace traverse::solve
