// A rank's rows of the matrix in the elimination, the blocks of one node, and a record of pivots.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "panel.hpp"
#include "solve/block_tridiagonal.hpp"

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

struct PivotRecord {
  double smallest_ratio = 1.0;      // smallest ratio of a pivot to its diagonal entry in the matrix
  std::ptrdiff_t bad_unknown = -1;  // the local unknown whose pivot is not positive; -1: none
  double bad_pivot = 0.0;
  double bad_diagonal = 0.0;
  bool failed() const { return bad_unknown >= 0; }
};

/// A rank's slice with identity rows and columns for fixed unknowns. Bit c of `next_fixed`: unknown c of the next
/// rank's first node is fixed. `original`, unless null, replaces the diagonal entries in the pivot ratio.
template <int B>
struct Slice {
  const BlockTridiagonal& matrix;
  const char* fixed;  // null: none
  std::uint64_t next_fixed;
  const double* original;  // null: the diagonal entries of the matrix

  Extent<B> block() const { return {matrix.block}; }

  Block<B> diagonal(std::ptrdiff_t node) const {
    Block<B> result(block(), matrix.diagonal.data() + node * block().area());
    if (fixed == nullptr) return result;
    for (int i = 0; i < block().size(); ++i) {
      if (!is_fixed(node, i)) continue;
      for (int j = 0; j < block().size(); ++j) result(i, j) = result(j, i) = 0.0;
      result(i, i) = 1.0;
    }
    return result;
  }

  /// The coupling of `node` (rows) to the next node (columns).
  Block<B> upper(std::ptrdiff_t node) const {
    Block<B> result(block(), matrix.upper.data() + node * block().area());
    if (fixed == nullptr && next_fixed == 0) return result;
    for (int i = 0; i < block().size(); ++i) {
      for (int j = 0; j < block().size(); ++j) {
        if (is_fixed(node, i) || is_fixed(node + 1, j)) result(i, j) = 0.0;
      }
    }
    return result;
  }

  /// Whether the diagonal blocks of two nodes, or their couplings to the next nodes, are equal to the last bit.
  bool same_diagonal(std::ptrdiff_t a, std::ptrdiff_t b) const {
    return same_entries(matrix.diagonal, a, b) && same_fixed(a, b);
  }
  bool same_upper(std::ptrdiff_t a, std::ptrdiff_t b) const {
    return same_entries(matrix.upper, a, b) && same_fixed(a, b) && same_fixed(a + 1, b + 1);
  }

  /// The diagonal entry with which the pivot of this unknown is compared.
  double reference(std::ptrdiff_t node, int i) const {
    if (original != nullptr) return original[node * block().size() + i];
    if (is_fixed(node, i)) return 1.0;
    return matrix.diagonal[static_cast<std::size_t>(node * block().area() + i * (block().size() + 1))];
  }

 private:
  bool is_fixed(std::ptrdiff_t node, int i) const {
    if (node == matrix.nodes) return ((next_fixed >> i) & 1U) != 0;
    return fixed != nullptr && fixed[node * block().size() + i] != 0;
  }
  bool same_fixed(std::ptrdiff_t a, std::ptrdiff_t b) const {
    if (fixed == nullptr && next_fixed == 0) return true;
    for (int i = 0; i < block().size(); ++i) {
      if (is_fixed(a, i) != is_fixed(b, i)) return false;
    }
    return true;
  }
  bool same_entries(const std::vector<double>& entries, std::ptrdiff_t a, std::ptrdiff_t b) const {
    const double* const first = entries.data() + a * block().area();
    return std::equal(first, first + block().area(), entries.data() + b * block().area());
  }
};

/// Replaces a node's pivot block (symmetric; only its lower triangle is read) by its inverse, by LDL^T, which is
/// insensitive to different units of the rows. Returns false, with an entry in the record, if a pivot is not positive.
template <int B>
bool invert(Block<B>& block, const Slice<B>& slice, std::ptrdiff_t node, PivotRecord& record) {
  const int n = block.size();
  Block<B> triangle(slice.block());  // W, the inverse of the unit lower triangle: W A W^T = pivots
  Block<B> scaled(slice.block());    // its rows divided by the pivots
  for (int i = 0; i < n; ++i) {
    triangle(i, i) = 1.0;
    for (int j = 0; j < i; ++j) {
      double entry = 0.0;
      for (int k = 0; k <= j; ++k) entry += scaled(j, k) * block(i, k);
      for (int k = 0; k <= j; ++k) triangle(i, k) -= entry * triangle(j, k);
    }
    double pivot = 0.0;
    for (int k = 0; k <= i; ++k) pivot += triangle(i, k) * block(i, k);
    const double reference = slice.reference(node, i);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) {
      record.bad_unknown = node * n + i;
      record.bad_pivot = pivot;
      record.bad_diagonal = reference;
      return false;
    }
    record.smallest_ratio = std::min(record.smallest_ratio, pivot / reference);
    const double inverse = 1.0 / pivot;
    for (int k = 0; k <= i; ++k) scaled(i, k) = triangle(i, k) * inverse;
  }
  for (int c = 0; c < n; ++c) {
    for (int r = c; r < n; ++r) {
      double sum = 0.0;
      for (int k = r; k < n; ++k) sum += triangle(k, r) * scaled(k, c);
      block(r, c) = block(c, r) = sum;
    }
  }
  return true;
}

}  // namespace traverse::solve
