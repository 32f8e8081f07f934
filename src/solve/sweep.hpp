// The two sweeps of a solve along N chains at once. A chain's next node waits for the one before, and that latency
// is the limit of one chain; independent chains in one loop fill the wait.
#pragma once

#include "panel.hpp"

namespace traverse::solve {

/// One chain's factors (see local_factor.hpp) and where its unknowns are: node k of the chain at x + k*step.
struct ChainView {
  const double* lower;
  const double* inverse;
  const double* fill;
  double* x;
  std::ptrdiff_t step;
};

/// The separator's unknowns, one panel a chain: gathered in the forward sweep, known in the backward sweep.
template <int B, int C, std::size_t N>
using Borders = std::array<Panel<B, C>, N>;

/// For k in [from, to): y_{k+1} -= L_k y_k, and with Fill border -= F_k y_k.
template <bool Fill, int B, int C, std::size_t N>
TRAVERSE_FLATTEN void sweep_forward(Extent<B> block, const std::array<ChainView, N>& chains, std::ptrdiff_t from,
                                    std::ptrdiff_t to, std::ptrdiff_t stride, Borders<B, C, N>& borders) {
  if (from >= to) return;
  std::array<Panel<B, C>, N> y;
  Borders<B, C, N> border;
  TRAVERSE_UNROLL
  for (std::size_t j = 0; j < N; ++j) {
    y[j].load(block, chains[j].x + from * chains[j].step, stride);
    if constexpr (Fill) border[j].copy(block, borders[j]);
  }
  for (std::ptrdiff_t k = from; k < to; ++k) {
    TRAVERSE_UNROLL
    for (std::size_t j = 0; j < N; ++j) {
      const ChainView& chain = chains[j];
      if constexpr (Fill) border[j].subtract(block, chain.fill + k * block.area(), y[j]);
      double* next = chain.x + (k + 1) * chain.step;
      Panel<B, C> value;
      value.load(block, next, stride);
      value.subtract(block, chain.lower + k * block.area(), y[j]);
      value.store(block, next, stride);
      y[j].copy(block, value);
    }
  }
  TRAVERSE_UNROLL
  for (std::size_t j = 0; j < N; ++j) {
    if constexpr (Fill) borders[j].copy(block, border[j]);
  }
}

/// For k from to - 1 down to from: x_k = D_k^{-1} y_k - L_k^T x_{k+1}, and with Fill - F_k^T border.
template <bool Fill, int B, int C, std::size_t N>
TRAVERSE_FLATTEN void sweep_backward(Extent<B> block, const std::array<ChainView, N>& chains, std::ptrdiff_t from,
                                     std::ptrdiff_t to, std::ptrdiff_t stride, const Borders<B, C, N>& borders) {
  if (from >= to) return;
  std::array<Panel<B, C>, N> x;
  Borders<B, C, N> border;
  TRAVERSE_UNROLL
  for (std::size_t j = 0; j < N; ++j) {
    x[j].load(block, chains[j].x + to * chains[j].step, stride);
    if constexpr (Fill) border[j].copy(block, borders[j]);
  }
  for (std::ptrdiff_t k = to - 1; k >= from; --k) {
    TRAVERSE_UNROLL
    for (std::size_t j = 0; j < N; ++j) {
      const ChainView& chain = chains[j];
      double* here = chain.x + k * chain.step;
      Panel<B, C> y;
      Panel<B, C> value;
      y.load(block, here, stride);
      value.multiply(block, chain.inverse + k * block.area(), y);
      if constexpr (Fill) value.subtract_transposed(block, chain.fill + k * block.area(), border[j]);
      value.subtract_transposed(block, chain.lower + k * block.area(), x[j]);
      value.store(block, here, stride);
      x[j].copy(block, value);
    }
  }
}

}  // namespace traverse::solve
