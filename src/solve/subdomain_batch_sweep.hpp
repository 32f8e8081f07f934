// The solution with a subdomain batch: function bodies that blocks.hpp compiles.
#pragma once

#include <algorithm>
#include <utility>

#include "subdomain_batch.hpp"

namespace traverse::solve {

// Number of elimination steps per sweep; values that a callback has written, or that several sweeps use, then remain in
// a cache.
inline constexpr std::ptrdiff_t tile = 128;

inline constexpr unsigned all_chains = (1U << lanes) - 1U;

/// Calls the callback for the nodes of each chain that its next steps need.
class RhsWriter {
 public:
  RhsWriter(RhsCallback* rhs_callback, const std::array<Run, lanes>& runs) : rhs_callback_(rhs_callback), runs_(runs) {
    for (std::size_t lane = 0; lane < lanes; ++lane) written_[lane] = runs[lane].from;
  }

  void middle(Range window, std::ptrdiff_t node) {
    if (rhs_callback_ != nullptr && window.contains(node)) rhs_callback_->fill(node, node + 1);
  }

  /// Writes up to the chain's node `past` or the end of its run.
  void advance(const Chain& chain, std::size_t lane, std::ptrdiff_t past) {
    if (rhs_callback_ == nullptr) return;
    past = std::min(past, runs_[lane].from + runs_[lane].nodes());
    if (written_[lane] >= past) return;
    const Range nodes = chain.nodes(written_[lane], past);
    rhs_callback_->fill(nodes.first, nodes.past);
    written_[lane] = past;
  }

 private:
  RhsCallback* rhs_callback_;
  const std::array<Run, lanes>& runs_;
  std::array<std::ptrdiff_t, lanes> written_ = {};
};

template <int B>
Factors SubdomainBatch<B>::factors(std::size_t lane, std::ptrdiff_t k) const {
  const std::ptrdiff_t place = stored_.at(k).storage_index(k);
  return {first(lower_, place * block_.area(), lane), first(inverse_, place * block_.triangle(), lane),
          k < fill_nodes_ ? first(fill_, k * block_.area(), lane) : nullptr};
}

template <int B>
LaneSweep<B> SubdomainBatch<B>::lane_sweep(const Columns& x, std::ptrdiff_t k) const {
  LaneSweep<B> result = {block_, factors(0, k), {}};
  for (std::size_t lane = 0; lane < lanes; ++lane) result.x[lane] = address(x, node(lane, k));
  return result;
}

template <int B>
template <int C, std::size_t N>
ColumnSweep<B, C, N> SubdomainBatch<B>::column_sweep(const Columns& x, std::size_t lane, std::ptrdiff_t k) const {
  ColumnSweep<B, C, N> result = {block_, factors(lane, k), {}, x.stride};
  for (std::size_t j = 0; j < N; ++j) {
    result.x[j] = {address(x, node(lane + j, k)), std::ptrdiff_t{chain(lane + j).direction} * block_.size()};
  }
  return result;
}

/// Calls body(sweep, first lane) for two chains of a part together if both have the steps, otherwise for one.
template <int B>
template <int C, class Body>
void SubdomainBatch<B>::along_columns(const Columns& x, const StepRange& steps, Body body) const {
  for (std::size_t lane = 0; lane < lanes; lane += 2) {
    const unsigned chains = (steps.chains >> lane) & 3U;
    if (chains == 3U) body(column_sweep<C, 2>(x, lane, steps.from), lane);
    if (chains == 1U) body(column_sweep<C, 1>(x, lane, steps.from), lane);
    if (chains == 2U) body(column_sweep<C, 1>(x, lane + 1, steps.from), lane + 1);
  }
}

template <int B>
template <bool Fill, int C>
void SubdomainBatch<B>::forward(const Columns& x, const StepRange& steps, ChainBorders<B, C>& borders) const {
  if constexpr (C == 1) {
    if (steps.chains == all_chains && steps.to <= common_steps_) {
      Borders<LaneSweep<B>> border;
      if constexpr (Fill) border[0].gather(block_, [&](int lane) { return borders[lane].lane.data(); });
      sweep_forward<Fill>(lane_sweep(x, steps.from), 0, steps.to - steps.from, border);
      if constexpr (Fill) border[0].scatter(block_, [&](int lane) { return borders[lane].lane.data(); });
      return;
    }
  }
  along_columns<C>(x, steps, [&](const auto& sweep, std::size_t lane) {
    Borders<std::decay_t<decltype(sweep)>> border;
    for (std::size_t j = 0; j < border.size(); ++j) border[j].copy(block_, borders[lane + j]);
    sweep_forward<Fill>(sweep, 0, steps.to - steps.from, border);
    for (std::size_t j = 0; j < border.size(); ++j) borders[lane + j].copy(block_, border[j]);
  });
}

template <int B>
template <bool Fill, int C>
void SubdomainBatch<B>::backward(const Columns& x, const StepRange& steps, const ChainBorders<B, C>& borders) const {
  if constexpr (C == 1) {
    if (steps.chains == all_chains && steps.to <= common_steps_) {
      Borders<LaneSweep<B>> border;
      border[0].gather(block_, [&](int lane) { return borders[lane].lane.data(); });
      sweep_backward<Fill>(lane_sweep(x, steps.from), 0, steps.to - steps.from, border);
      return;
    }
  }
  along_columns<C>(x, steps, [&](const auto& sweep, std::size_t lane) {
    Borders<std::decay_t<decltype(sweep)>> border;
    for (std::size_t j = 0; j < border.size(); ++j) border[j].copy(block_, borders[lane + j]);
    sweep_backward<Fill>(sweep, 0, steps.to - steps.from, border);
  });
}

/// The last node k of an open run: border -= F_k y_k.
template <int B>
template <int C>
void SubdomainBatch<B>::forward_end(const Columns& x, std::size_t lane, std::ptrdiff_t k, Panel<B, C>& border) const {
  if (k >= fill_nodes_) return;
  const ColumnSweep<B, C, 1> sweep = column_sweep<C, 1>(x, lane, k);
  Panel<B, C> y;
  sweep.load(y, 0, 0);
  border.subtract(block_, sweep.entries(sweep.factors.fill, 0, 0), y);
}

/// x_k = D_k^{-1} y_k - F_k^T border: the solution behind the run is zero.
template <int B>
template <int C>
void SubdomainBatch<B>::backward_end(const Columns& x, std::size_t lane, std::ptrdiff_t k,
                                     const Panel<B, C>& border) const {
  const ColumnSweep<B, C, 1> sweep = column_sweep<C, 1>(x, lane, k);
  Panel<B, C> y, value;
  sweep.load(y, 0, 0);
  value.multiply_symmetric(block_, sweep.entries(sweep.factors.inverse, 0, 0), y);
  if (k < fill_nodes_) value.subtract_transposed(block_, sweep.entries(sweep.factors.fill, 0, 0), border);
  sweep.store(value, 0, 0);
}

template <int B>
template <int C>
void SubdomainBatch<B>::solve_middle(const Columns& x, std::size_t part, const ChainBorders<B, C>& borders) const {
  double* here = address(x, parts_[part].middle);
  Panel<B, C> reduced, middle;
  reduced.load(block_, here, x.stride);
  middle.multiply(block_, middle_inverse_[part].data(), reduced);
  for (std::size_t lane : {2 * part, 2 * part + 1}) {
    if (chain(lane).bordered) middle.subtract_transposed(block_, middle_fill_[lane].data(), borders[lane]);
  }
  middle.store(block_, here, x.stride);
}

/// x: the unknowns of node 0.
template <int B>
template <int C, bool Packed>
TRAVERSE_FLATTEN void SubdomainBatch<B>::solve_single(double* x, std::ptrdiff_t stride) const {
  const std::ptrdiff_t step = block_.size() * (Packed ? C : 1);  // NOLINT(bugprone-branch-clone): equal for C = 1
  const Factors all = factors(0, 0);
  const std::ptrdiff_t longer = chain(0).count;
  const std::ptrdiff_t shorter = chain(1).count;
  const ChainUnknowns right = {x, step};
  const ColumnSweep<B, C, 2, Packed> both = {block_, all, {right, {x + chain(1).first * step, -step}}, stride};
  const ColumnSweep<B, C, 1, Packed> first = {block_, all, {right}, stride};
  Borders<ColumnSweep<B, C, 2>> none;
  Borders<ColumnSweep<B, C, 1>> none_either;
  sweep_forward<false>(both, 0, shorter, none);
  sweep_forward<false>(first, shorter, longer, none_either);
  Panel<B, C> reduced, middle;
  first.load(reduced, 0, longer);
  middle.multiply(block_, middle_inverse_[0].data(), reduced);
  first.store(middle, 0, longer);
  sweep_backward<false>(first, shorter, longer, none_either);
  sweep_backward<false>(both, 0, shorter, none);
}

template <int B>
template <int C>
TRAVERSE_FLATTEN void SubdomainBatch<B>::solve_single(const Columns& x) const {
  constexpr std::size_t capacity = 2048;  // numbers: half of a first-level cache
  const std::ptrdiff_t nodes = nodes_.past;
  const std::ptrdiff_t node_size = block_.size() * C;
  if (C == 1 || nodes * node_size > static_cast<std::ptrdiff_t>(capacity)) return solve_single<C, false>(x.x, x.stride);
  alignas(64) std::array<double, capacity> packed;
  Panel<B, C> node;
  for (std::ptrdiff_t i = 0; i < nodes; ++i) {
    node.load(block_, x.x + i * block_.size(), x.stride);
    node.store_packed(block_, packed.data() + i * node_size);
  }
  solve_single<C, true>(packed.data(), 0);
  for (std::ptrdiff_t i = 0; i < nodes; ++i) {
    node.load_packed(block_, packed.data() + i * node_size);
    node.store(block_, x.x + i * block_.size(), x.stride);
  }
}

template <int B>
template <int C>
void SubdomainBatch<B>::forward(const Columns& x, Range window, RhsCallback* rhs_callback,
                                ChainBorders<B, C>& borders) const {
  Plan buffer;
  const Plan& steps = plan(window, buffer);
  RhsWriter rhs_writer(rhs_callback, steps.runs);
  for (const Part& part : parts_) rhs_writer.middle(window, part.middle);
  for (std::size_t i = 0; i < steps.count; ++i) {
    StepRange now = steps.ranges[i];
    for (std::ptrdiff_t past = now.to; now.from < past; now.from = now.to) {
      now.to = std::min(now.from + tile, past);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        if ((now.chains >> lane & 1U) != 0) rhs_writer.advance(chain(lane), lane, now.to + 1);
      }
      for (StepRange row = now; row.from < now.to; row.from = row.to) {
        row.to = std::min(now.to, stored_.at(row.from).row_end(row.from));
        row.to <= fill_nodes_ ? forward<true>(x, row, borders) : forward<false>(x, row, borders);
      }
    }
  }
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    rhs_writer.advance(chain(lane), lane, chain(lane).count);
    if (steps.runs[lane].open) forward_end(x, lane, steps.runs[lane].to, borders[lane]);
  }
  for (std::size_t part = 0; part < parts_per_batch; ++part) {
    if (!window.contains(parts_[part].middle)) continue;
    Panel<B, C> middle;
    middle.load(block_, address(x, parts_[part].middle), x.stride);
    for (std::size_t lane : {2 * part, 2 * part + 1}) {
      if (chain(lane).bordered) borders[lane].subtract(block_, middle_fill_[lane].data(), middle);
    }
  }
}

template <int B>
template <int C>
void SubdomainBatch<B>::backward(const Columns& x, Range window, const ChainBorders<B, C>& borders) const {
  Plan buffer;
  const Plan& steps = plan(window, buffer);
  for (std::size_t part = 0; part < parts_per_batch; ++part) {
    if (window.contains(parts_[part].middle)) solve_middle<C>(x, part, borders);
  }
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (steps.runs[lane].open) backward_end(x, lane, steps.runs[lane].to, borders[lane]);
  }
  for (std::size_t i = steps.count; i-- > 0;) {
    StepRange now = steps.ranges[i];
    for (const std::ptrdiff_t from = now.from; now.to > from; now.to = now.from) {
      now.from = std::max(now.to - tile, from);
      for (StepRange row = now; row.to > now.from; row.to = row.from) {
        row.from = std::max(now.from, stored_.at(row.to - 1).row_begin(row.to - 1));
        row.to <= fill_nodes_ ? backward<true>(x, row, borders) : backward<false>(x, row, borders);
      }
    }
  }
}

}  // namespace traverse::solve
