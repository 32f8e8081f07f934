// The two sweeps of a solve along several chains at once. Each node of a chain needs the result of the node before;
// this latency limits one chain, and the work on other chains fills the waiting time. The factors of `lanes` chains are
// stored together, entry by entry. A single column is processed along all chains, one in each SIMD lane (LaneSweep);
// several columns use the SIMD lanes themselves and are processed along one or two chains (ColumnSweep).
#pragma once

#include "panel.hpp"

namespace traverse::solve {

/// The chains with a common storage of factors: even ones run to the right, odd ones to the left.
inline constexpr int lanes = 4;

/// The factors from a lane on. Entry e of node k of that lane's chain is at [(k*entries + e)*lanes], with block*block
/// entries, or for the symmetric inverse those of the lower triangle.
struct Factors {
  const double* lower;
  const double* inverse;
  const double* fill;
};

/// Node k of one chain is at `at` + k*step.
struct ChainUnknowns {
  double* at;
  std::ptrdiff_t step;
};

struct LaneEntries {
  const double* first;
  Lane<lanes> operator[](std::ptrdiff_t entry) const { return load_lane<lanes>(first + entry * lanes); }
};

struct ChainEntries {
  const double* first;
  double operator[](std::ptrdiff_t entry) const { return first[entry * lanes]; }
};

/// One column along all chains.
template <int B>
struct LaneSweep {
  using Unknowns = Panel<B, lanes>;
  static constexpr std::size_t panels = 1;
  Extent<B> block;
  Factors factors;
  std::array<double*, lanes> x;  // unknowns of the chains' nodes 0

  LaneEntries entries(const double* of, std::size_t /*panel*/, std::ptrdiff_t at) const { return {of + at * lanes}; }
  double* address(int lane, std::ptrdiff_t k) const {
    const std::ptrdiff_t way = k * block.size();
    return x[static_cast<std::size_t>(lane)] + (lane % 2 == 0 ? way : -way);
  }
  void load(Unknowns& to, std::size_t /*panel*/, std::ptrdiff_t k) const {
    to.gather(block, [&](int lane) { return address(lane, k); });
  }
  void store(const Unknowns& from, std::size_t /*panel*/, std::ptrdiff_t k) const {
    from.scatter(block, [&](int lane) { return address(lane, k); });
  }
};

/// C columns along N neighbouring chains. The entries of a column are `stride` behind the entries of the previous
/// column; if they are packed, the columns of each unknown are contiguous, and so are the unknowns of a node.
template <int B, int C, std::size_t N, bool Packed = false>
struct ColumnSweep {
  using Unknowns = Panel<B, C>;
  static constexpr std::size_t panels = N;
  Extent<B> block;
  Factors factors;
  std::array<ChainUnknowns, N> x;
  std::ptrdiff_t stride;

  ChainEntries entries(const double* of, std::size_t panel, std::ptrdiff_t at) const {
    return {of + at * lanes + panel};
  }
  void load(Unknowns& to, std::size_t panel, std::ptrdiff_t k) const {
    const double* at = x[panel].at + k * x[panel].step;
    Packed ? to.load_packed(block, at) : to.load(block, at, stride);
  }
  void store(const Unknowns& from, std::size_t panel, std::ptrdiff_t k) const {
    double* at = x[panel].at + k * x[panel].step;
    Packed ? from.store_packed(block, at) : from.store(block, at, stride);
  }
};

/// The separator's unknowns for each panel: accumulated in the forward sweep, given in the backward sweep.
template <class Sweep>
using Borders = std::array<typename Sweep::Unknowns, Sweep::panels>;

/// For k in [from, to): y_{k+1} -= L_k y_k, and with Fill border -= F_k y_k.
template <bool Fill, class Sweep>
TRAVERSE_FLATTEN void sweep_forward(const Sweep& sweep, std::ptrdiff_t from, std::ptrdiff_t to,
                                    Borders<Sweep>& borders) {
  const auto block = sweep.block;
  Borders<Sweep> y;
  Borders<Sweep> border;
  TRAVERSE_UNROLL
  for (std::size_t j = 0; j < Sweep::panels; ++j) {
    sweep.load(y[j], j, from);
    if constexpr (Fill) border[j].copy(block, borders[j]);
  }
  for (std::ptrdiff_t k = from; k < to; ++k) {
    TRAVERSE_UNROLL
    for (std::size_t j = 0; j < Sweep::panels; ++j) {
      if constexpr (Fill) border[j].subtract(block, sweep.entries(sweep.factors.fill, j, k * block.area()), y[j]);
      typename Sweep::Unknowns next;
      sweep.load(next, j, k + 1);
      next.subtract(block, sweep.entries(sweep.factors.lower, j, k * block.area()), y[j]);
      sweep.store(next, j, k + 1);
      y[j].copy(block, next);
    }
  }
  TRAVERSE_UNROLL
  for (std::size_t j = 0; j < Sweep::panels; ++j) {
    if constexpr (Fill) borders[j].copy(block, border[j]);
  }
}

/// For k from to - 1 down to from: x_k = D_k^{-1} y_k - L_k^T x_{k+1}, and with Fill - F_k^T border.
template <bool Fill, class Sweep>
TRAVERSE_FLATTEN void sweep_backward(const Sweep& sweep, std::ptrdiff_t from, std::ptrdiff_t to,
                                     const Borders<Sweep>& borders) {
  const auto block = sweep.block;
  Borders<Sweep> x;
  Borders<Sweep> border;
  TRAVERSE_UNROLL
  for (std::size_t j = 0; j < Sweep::panels; ++j) {
    sweep.load(x[j], j, to);
    if constexpr (Fill) border[j].copy(block, borders[j]);
  }
  for (std::ptrdiff_t k = to - 1; k >= from; --k) {
    TRAVERSE_UNROLL
    for (std::size_t j = 0; j < Sweep::panels; ++j) {
      typename Sweep::Unknowns y;
      typename Sweep::Unknowns value;
      sweep.load(y, j, k);
      value.multiply_symmetric(block, sweep.entries(sweep.factors.inverse, j, k * block.triangle()), y);
      if constexpr (Fill) {
        value.subtract_transposed(block, sweep.entries(sweep.factors.fill, j, k * block.area()), border[j]);
      }
      value.subtract_transposed(block, sweep.entries(sweep.factors.lower, j, k * block.area()), x[j]);
      sweep.store(value, j, k);
      x[j].copy(block, value);
    }
  }
}

}  // namespace traverse::solve
