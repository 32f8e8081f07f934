// The columns of a structure on one rank, its rows of the matrices, and their conversion to PETSc matrices.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/petsc.hpp"
#include "beam/element.hpp"
#include "beam/line.hpp"

namespace traverse::beam {

/// Converts to the unsigned index type of the standard library.
constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The columns of a rank, and the held or unused unknowns in them and in one further column on each side. An unknown is
/// unused if its column contains nothing that it belongs to (no sleeper, no bridge, no hinge).
struct Slice {
  Slice(int block_size, int first_column, int local_columns);

  bool owns(int unknown) const { return unknown >= first * block && unknown < (first + local) * block; }
  bool reaches(int unknown) const { return unknown >= (first - 1) * block && unknown < (first + local + 1) * block; }
  /// The unknown must be in a column that `reaches` includes.
  bool held(int unknown) const { return held_[index(unknown - (first - 1) * block)] != 0; }
  void hold(int unknown) { set(unknown, 1); }
  void release(int unknown) { set(unknown, 0); }

  int block = 0, first = 0, local = 0;

 private:
  void set(int unknown, char held) {
    if (unknown >= 0 && reaches(unknown)) held_[index(unknown - (first - 1) * block)] = held;
  }
  std::vector<char> held_;  // initially all
};

/// Rows of a symmetric block tridiagonal matrix for the columns of a slice, held unknowns included.
class Rows {
 public:
  explicit Rows(const Slice& slice)
      : slice_(&slice), values_(3 * index(slice.local) * index(slice.block) * index(slice.block)) {}

  /// Adds the part of an N x N matrix on the given global unknowns (-1: ignored) that belongs to this slice. Entries
  /// between columns that are not neighbours must be zero.
  template <std::size_t N>
  void add(const std::array<int, N>& unknowns, const std::array<double, N * N>& matrix) {
    for (std::size_t i = 0; i < N; ++i) {
      if (unknowns[i] < 0 || !slice_->owns(unknowns[i])) continue;
      for (std::size_t j = 0; j < N; ++j) {
        if (unknowns[j] >= 0 && matrix[i * N + j] != 0.0) add(unknowns[i], unknowns[j], matrix[i * N + j]);
      }
    }
  }
  void add(double factor, const Rows& other);
  /// Entry of an owned row and an unknown in the same or a neighbouring column.
  double at(int row, int column) const { return values_[place(row, column)]; }
  /// The product of an owned row with a vector given by value(unknown), including held unknowns.
  template <class Value>
  double times(int row, Value value) const {
    double sum = 0.0;
    const int from = (row / slice_->block - 1) * slice_->block;
    for (int j = 0; j < 3 * slice_->block; ++j) {
      const double entry = values_[place(row, from + j)];
      if (entry != 0.0) sum += entry * value(from + j);
    }
    return sum;
  }

  /// Collective. The matrix with empty rows and columns of held unknowns, and with the non-zeros of `pattern`.
  base::Handle<Mat> matrix(MPI_Comm comm, const Rows& pattern) const;
  /// Adds the magnitudes of another matrix's entries, for a common pattern.
  void add_pattern(const Rows& other);

 private:
  std::size_t place(int row, int column) const {
    const int b = slice_->block;
    const int offset = column / b - row / b + 1;
    return (index(row - slice_->first * b) * 3 + index(offset)) * index(b) + index(column % b);
  }
  void add(int row, int column, double value);

  const Slice* slice_;
  std::vector<double> values_;
};

}  // namespace traverse::beam
