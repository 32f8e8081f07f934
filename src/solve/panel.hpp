// Small dense matrices of one node that the sweeps keep in registers: a block of unknowns times a few columns.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

// The parts of a sweep must be inlined into one function and its short loops unrolled, so that its values remain in
// registers: this is four times faster. It is disabled without optimisation and under sanitizers, whose checks would
// make the function very large.
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TRAVERSE_FLATTEN [[gnu::flatten]]
#else
#define TRAVERSE_FLATTEN
#define TRAVERSE_KEEP_LOOPS
#endif
#ifdef TRAVERSE_KEEP_LOOPS
#define TRAVERSE_UNROLL
#else
#define TRAVERSE_UNROLL _Pragma("GCC unroll 8")
#endif

namespace traverse::solve {

/// Sizes 2 to 7 are compiled for their size, all others up to the largest use `any_block`.
inline constexpr int largest_block = 16;
inline constexpr int any_block = -1;

template <int B>
inline constexpr int storage_block = B == any_block ? largest_block : B;

/// The number of unknowns per node: a compile-time constant, or a run-time value for any_block.
template <int B>
struct Extent {
  int run_time = B;
  constexpr int size() const { return B == any_block ? run_time : B; }
  constexpr std::ptrdiff_t area() const { return static_cast<std::ptrdiff_t>(size()) * size(); }
  constexpr std::ptrdiff_t triangle() const { return (area() + size()) / 2; }
};

template <int C>
struct LaneOf {
  using Type [[gnu::vector_size(C * sizeof(double))]] = double;
  using Stored [[gnu::vector_size(C * sizeof(double)), gnu::may_alias, gnu::aligned(sizeof(double))]] = double;
};
template <>
struct LaneOf<1> {
  using Type = double;
  using Stored = double;
};

/// One unknown in each of C = 1, 2, 4 or 8 columns, or of C chains; arithmetic is entry by entry.
template <int C>
using Lane = typename LaneOf<C>::Type;

template <int C>
Lane<C> load_lane(const double* from) {
  return *reinterpret_cast<const typename LaneOf<C>::Stored*>(from);
}

template <int C>
void store_lane(double* to, const Lane<C>& lane) {
  *reinterpret_cast<typename LaneOf<C>::Stored*>(to) = lane;
}

/// low[c] = at(c)[0], high[c] = at(c)[1] for c < C.
template <int C, class Address>
void load_pair(Address at, Lane<C>& low, Lane<C>& high) {
  if constexpr (C == 2) {
    const Lane<2> even = load_lane<2>(at(0)), odd = load_lane<2>(at(1));
    low = __builtin_shufflevector(even, odd, 0, 2);
    high = __builtin_shufflevector(even, odd, 1, 3);
  } else if constexpr (C == 4) {
    const Lane<4> even = __builtin_shufflevector(load_lane<2>(at(0)), load_lane<2>(at(2)), 0, 1, 2, 3);
    const Lane<4> odd = __builtin_shufflevector(load_lane<2>(at(1)), load_lane<2>(at(3)), 0, 1, 2, 3);
    low = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    high = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
  } else {
    Lane<4> first_low, first_high, last_low, last_high;
    load_pair<4>(at, first_low, first_high);
    load_pair<4>([&](int c) { return at(c + 4); }, last_low, last_high);
    low = __builtin_shufflevector(first_low, last_low, 0, 1, 2, 3, 4, 5, 6, 7);
    high = __builtin_shufflevector(first_high, last_high, 0, 1, 2, 3, 4, 5, 6, 7);
  }
}

/// The inverse of load_pair.
template <int C, class Address>
void store_pair(Address at, const Lane<C>& low, const Lane<C>& high) {
  if constexpr (C == 2) {
    store_lane<2>(at(0), __builtin_shufflevector(low, high, 0, 2));
    store_lane<2>(at(1), __builtin_shufflevector(low, high, 1, 3));
  } else if constexpr (C == 4) {
    const Lane<4> even = __builtin_shufflevector(low, high, 0, 4, 2, 6);
    const Lane<4> odd = __builtin_shufflevector(low, high, 1, 5, 3, 7);
    store_lane<2>(at(0), __builtin_shufflevector(even, even, 0, 1));
    store_lane<2>(at(1), __builtin_shufflevector(odd, odd, 0, 1));
    store_lane<2>(at(2), __builtin_shufflevector(even, even, 2, 3));
    store_lane<2>(at(3), __builtin_shufflevector(odd, odd, 2, 3));
  } else {
    store_pair<4>(at, __builtin_shufflevector(low, low, 0, 1, 2, 3), __builtin_shufflevector(high, high, 0, 1, 2, 3));
    store_pair<4>([&](int c) { return at(c + 4); }, __builtin_shufflevector(low, low, 4, 5, 6, 7),
                  __builtin_shufflevector(high, high, 4, 5, 6, 7));
  }
}

/// The index of a symmetric block's entry in its lower triangle, which is stored row after row.
constexpr int packed(int row, int column) {
  return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
}

/// The unknowns of one node in C columns, or of one node of each of C chains. The matrices below may be any type whose
/// operator[] returns an entry: one number, or one for each column.
template <int B, int C>
struct Panel {
  std::array<Lane<C>, storage_block<B>> lane;

  /// The entries of column c are at at(c).
  template <class Address>
  void gather(Extent<B> block, Address at) {
    const int n = block.size();
    if constexpr (C == 1) {
      TRAVERSE_UNROLL
      for (int r = 0; r < n; ++r) lane[r] = at(0)[r];
    } else {
      TRAVERSE_UNROLL
      for (int r = 0; r + 1 < n; r += 2) load_pair<C>([&](int c) { return at(c) + r; }, lane[r], lane[r + 1]);
      if (n % 2 == 1) {
        TRAVERSE_UNROLL
        for (int c = 0; c < C; ++c) lane[n - 1][c] = at(c)[n - 1];
      }
    }
  }

  template <class Address>
  void scatter(Extent<B> block, Address at) const {
    const int n = block.size();
    if constexpr (C == 1) {
      TRAVERSE_UNROLL
      for (int r = 0; r < n; ++r) at(0)[r] = lane[r];
    } else {
      TRAVERSE_UNROLL
      for (int r = 0; r + 1 < n; r += 2) store_pair<C>([&](int c) { return at(c) + r; }, lane[r], lane[r + 1]);
      if (n % 2 == 1) {
        TRAVERSE_UNROLL
        for (int c = 0; c < C; ++c) at(c)[n - 1] = lane[n - 1][c];
      }
    }
  }

  /// The entries of a column are `stride` behind the entries of the previous column.
  void load(Extent<B> block, const double* x, std::ptrdiff_t stride) {
    gather(block, [=](int c) { return x + c * stride; });
  }
  void store(Extent<B> block, double* x, std::ptrdiff_t stride) const {
    scatter(block, [=](int c) { return x + c * stride; });
  }

  /// The columns of an unknown are contiguous.
  void load_packed(Extent<B> block, const double* x) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) lane[r] = load_lane<C>(x + r * C);
  }
  void store_packed(Extent<B> block, double* x) const {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) store_lane<C>(x + r * C, lane[r]);
  }

  void copy(Extent<B> block, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) lane[r] = other.lane[r];
  }

  void add(Extent<B> block, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) lane[r] += other.lane[r];
  }

  /// this = matrix * other, for the packed lower triangle of a symmetric block x block matrix.
  template <class Matrix>
  void multiply_symmetric(Extent<B> block, const Matrix& matrix, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) lane[r] = matrix[packed(r, 0)] * other.lane[0];
    TRAVERSE_UNROLL
    for (int c = 1; c < n; ++c) {
      TRAVERSE_UNROLL
      for (int r = 0; r < n; ++r) lane[r] += matrix[packed(r, c)] * other.lane[c];
    }
  }

  /// this = matrix * other, for a column-major block x block matrix.
  template <class Matrix>
  void multiply(Extent<B> block, const Matrix& matrix, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int r = 0; r < n; ++r) lane[r] = matrix[r] * other.lane[0];
    TRAVERSE_UNROLL
    for (int c = 1; c < n; ++c) {
      TRAVERSE_UNROLL
      for (int r = 0; r < n; ++r) lane[r] += matrix[r + c * n] * other.lane[c];
    }
  }

  /// this -= matrix * other, for a column-major block x block matrix.
  template <class Matrix>
  void subtract(Extent<B> block, const Matrix& matrix, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int c = 0; c < n; ++c) {
      TRAVERSE_UNROLL
      for (int r = 0; r < n; ++r) lane[r] -= matrix[r + c * n] * other.lane[c];
    }
  }

  /// this -= transpose(matrix) * other.
  template <class Matrix>
  void subtract_transposed(Extent<B> block, const Matrix& matrix, const Panel& other) {
    const int n = block.size();
    TRAVERSE_UNROLL
    for (int c = 0; c < n; ++c) {
      TRAVERSE_UNROLL
      for (int r = 0; r < n; ++r) lane[r] -= matrix[c + r * n] * other.lane[c];
    }
  }
};

}  // namespace traverse::solve
