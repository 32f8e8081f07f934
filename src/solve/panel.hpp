// The small dense pieces of one node that the sweeps keep in registers: a block of unknowns times a few columns.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

// A sweep's pieces have to become one function, its short loops straight code, for its numbers to stay in registers:
// four times faster. Not so where nothing is optimised, nor under sanitizers, whose checks would make it huge.
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TRAVERSE_FLATTEN [[gnu::flatten]]
#define TRAVERSE_UNROLL _Pragma("GCC unroll 8")
#else
#define TRAVERSE_FLATTEN
#define TRAVERSE_UNROLL
#endif

namespace traverse::solve {

/// Sizes 2 to 7 are compiled for their size, all others up to the largest run through `any_block`.
inline constexpr int largest_block = 16;
inline constexpr int any_block = -1;

template <int B>
inline constexpr int storage_block = B == any_block ? largest_block : B;

/// The number of unknowns a node: known when compiling, or at run time for any_block.
template <int B>
struct Extent {
  int run_time = B;
  constexpr int size() const { return B == any_block ? run_time : B; }
  constexpr std::ptrdiff_t area() const { return static_cast<std::ptrdiff_t>(size()) * size(); }
};

template <int C>
struct LaneOf {
  using Type [[gnu::vector_size(C * sizeof(double))]] = double;
};
template <>
struct LaneOf<1> {
  using Type = double;
};

/// One unknown of C = 1, 2 or 4 columns; arithmetic is entry by entry.
template <int C>
using Lane = typename LaneOf<C>::Type;

/// The unknowns of one node in C columns. A column's entries lie `stride` behind those of the column before.
template <int B, int C>
struct Panel {
  std::array<Lane<C>, storage_block<B>> lane;

  void load(Extent<B> block, const double* x, std::ptrdiff_t stride) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) {
      if constexpr (C == 1) lane[r] = x[r];
      if constexpr (C == 2) lane[r] = Lane<C>{x[r], x[r + stride]};
      if constexpr (C == 4) lane[r] = Lane<C>{x[r], x[r + stride], x[r + 2 * stride], x[r + 3 * stride]};
    }
  }

  void store(Extent<B> block, double* x, std::ptrdiff_t stride) const {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) {
      if constexpr (C == 1) {
        x[r] = lane[r];
      } else {
        TRAVERSE_UNROLL
        for (int c = 0; c < C; ++c) x[r + c * stride] = lane[r][c];
      }
    }
  }

  void copy(Extent<B> block, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) lane[r] = other.lane[r];
  }

  /// this = matrix * other, the matrix block x block and column-major.
  void multiply(Extent<B> block, const double* matrix, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) lane[r] = Lane<C>{};
    TRAVERSE_UNROLL
    for (int c = 0; c < n; ++c) {
      TRAVERSE_UNROLL
      for (int r = 0; r < n; ++r) lane[r] += matrix[r + c * n] * other.lane[c];
    }
  }

  /// this -= matrix * other.
  void subtract(Extent<B> block, const double* matrix, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int c = 0; c < n; ++c) {
      TRAVERSE_UNROLL
      for (int r = 0; r < n; ++r) lane[r] -= matrix[r + c * n] * other.lane[c];
    }
  }

  /// this -= transpose(matrix) * other.
  void subtract_transposed(Extent<B> block, const double* matrix, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int c = 0; c < n; ++c) {
      TRAVERSE_UNROLL
      for (int r = 0; r < n; ++r) lane[r] -= matrix[c + r * n] * other.lane[c];
    }
  }
};

}  // namespace traverse::solve
