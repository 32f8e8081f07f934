// The factorisation of a subdomain batch, which stores repeating values once: function bodies that blocks.hpp compiles.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "subdomain_batch.hpp"

namespace traverse::solve {

// Inverse pivot blocks of two elimination steps are equal if they differ by rounding errors only: by the effect of a
// change of the matrix by `rounding`, relative to the roots of its diagonal entries. If pivots decrease slowly along a
// chain without supports, such changes accumulate. The blocks must therefore also be equal to the relative tolerance
// `repeat_tolerance`.
inline constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();
inline constexpr double repeat_tolerance = 1e-10;

/// The coupling of a chain's node k (rows) to the next node (columns).
template <int B>
Block<B> SubdomainBatch<B>::coupling(const Slice<B>& slice, std::size_t lane, std::ptrdiff_t k) const {
  const std::ptrdiff_t here = node(lane, k);
  return chain(lane).direction > 0 ? slice.upper(here) : slice.upper(here - 1).transpose();
}

template <int B>
Block<B> SubdomainBatch<B>::stored_inverse(std::size_t lane, std::ptrdiff_t k) const {
  const LaneEntry* from = inverse_.data() + stored_.at(k).storage_index(k) * block_.triangle();
  Block<B> result(block_);
  for (int c = 0; c < block_.size(); ++c) {
    for (int r = 0; r < block_.size(); ++r) result(r, c) = from[packed(r, c)].chain[lane];
  }
  return result;
}

/// A hash for each step, equal for steps with the same rows in all chains.
template <int B>
std::vector<std::uint64_t> SubdomainBatch<B>::hashes(const Slice<B>& slice) const {
  std::vector<std::uint64_t> result(static_cast<std::size_t>(steps_), 0);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    for (std::ptrdiff_t k = 0; k < chain(lane).count; ++k) {
      std::uint64_t& hash = result[static_cast<std::size_t>(k)];
      for (const Block<B>& block : {slice.diagonal(node(lane, k)), coupling(slice, lane, k)}) {
        hash = hash_of(hash, std::span(block.data(), static_cast<std::size_t>(block_.area())));
      }
    }
  }
  return result;
}

template <int B>
bool SubdomainBatch<B>::same_rows(const Slice<B>& slice, std::ptrdiff_t k, std::ptrdiff_t period) const {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (k >= chain(lane).count) continue;
    const std::ptrdiff_t now = node(lane, k), before = node(lane, k - period);
    const std::ptrdiff_t to_next = chain(lane).direction > 0 ? 0 : 1;
    if (!slice.same_diagonal(now, before) || !slice.same_upper(now - to_next, before - to_next)) return false;
  }
  return true;
}

/// Compares the pivots to rounding. If they and the rows are equal, all other values are equal too.
template <int B>
bool SubdomainBatch<B>::same_pivots(const Slice<B>& slice, std::ptrdiff_t k, std::ptrdiff_t period) const {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (k >= chain(lane).count) continue;
    const Block<B> now = stored_inverse(lane, k), before = stored_inverse(lane, k - period);
    const Block<B> diagonal = slice.diagonal(node(lane, k));
    for (int c = 0; c < block_.size(); ++c) {
      for (int r = c; r < block_.size(); ++r) {
        const double change = now(r, c) - before(r, c), size = now(r, r) * now(c, c);
        const double part =
            std::min(repeat_tolerance * repeat_tolerance, rounding * rounding * diagonal(r, r) * diagonal(c, c) * size);
        if (!(change * change <= part * size)) return false;
      }
    }
  }
  return true;
}

/// Uses the values of the previous period for the steps from `from` on whose rows repeat. Returns the first step whose
/// rows do not repeat.
template <int B>
std::ptrdiff_t SubdomainBatch<B>::repeat(const Slice<B>& slice, std::ptrdiff_t from, std::ptrdiff_t period,
                                         std::array<Front, lanes>& fronts) {
  std::ptrdiff_t to = from;
  while (to < steps_ && same_rows(slice, to, period)) ++to;
  if (to - from < period) return from;
  for (std::ptrdiff_t missing = stored_.repeat(from, to, period); missing > 0; --missing) {
    extend_store();
    std::copy_n(lower_.end() - (period + 1) * block_.area(), block_.area(), lower_.end() - block_.area());
    std::copy_n(inverse_.end() - (period + 1) * block_.triangle(), block_.triangle(),
                inverse_.end() - block_.triangle());
  }
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const std::ptrdiff_t past = std::min(to, chain(lane).count);
    for (std::ptrdiff_t k = from; k < past && fronts[lane].has_fill; ++k) {
      extend_fill(stored_inverse(lane, k), coupling(slice, lane, k), fronts[lane]);
    }
    if (past <= from) continue;
    const Block<B> last = coupling(slice, lane, past - 1);
    fronts[lane].update = last.transpose() * stored_inverse(lane, past - 1) * last;
  }
  return to;
}

// The fill is dropped from the first node on at which every entry is below this fraction of its largest value so far.
// The limit is far below rounding, so that the solution is exact, and far above the range of subnormal numbers.
inline constexpr double negligible = 1e-30;

/// The data of a chain that are passed from one node to the next in the factorisation.
template <int B>
struct SubdomainBatch<B>::Front {
  Block<B> update;             // U^T D^{-1} U: subtracted from the next node's diagonal block
  Block<B> fill;               // S: coupling of the separator with the next node
  Block<B> separator;          // sum of S D^{-1} S^T: subtracted from the separator's diagonal block
  Block<B> peak;               // largest magnitudes of the stored fill's entries
  std::vector<double> stored;  // S D^{-1}, one block per node
  bool has_fill = false;
};

template <int B>
SubdomainBatch<B>::SubdomainBatch(Extent<B> block, const std::array<Part, parts_per_batch>& parts)
    : block_(block), parts_(parts), nodes_{parts.front().nodes.first, parts.front().nodes.past} {
  std::ptrdiff_t shortest = chain(0).count;
  std::ptrdiff_t longest = 0;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    shortest = std::min(shortest, chain(lane).count);
    longest = std::max(longest, chain(lane).count);
  }
  for (const Part& part : parts_) nodes_.past = std::max(nodes_.past, part.nodes.past);
  common_steps_ = std::max<std::ptrdiff_t>(0, shortest - 1);
  steps_ = longest;
}

template <int B>
bool SubdomainBatch<B>::factor(const Slice<B>& slice, PivotRecord& record) {
  const Block<B> zero(block_);
  std::array<Front, lanes> fronts;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const Chain& here = chain(lane);
    Block<B> fill = zero;
    if (here.bordered) fill = here.direction > 0 ? slice.upper(here.first - 1) : slice.upper(here.first).transpose();
    fronts[lane] = {zero, fill, zero, zero, {}, here.bordered};
  }
  if (!eliminate_chains(slice, fronts, record)) return false;
  store_fill(fronts);
  for (std::size_t part = 0; part < parts_per_batch; ++part) {
    if (parts_[part].middle >= 0 && !eliminate_middle(slice, part, &fronts[2 * part], record)) return false;
    if (parts_[part].middle < 0 && !parts_[part].nodes.empty()) {
      const std::ptrdiff_t separator = parts_[part].nodes.first;
      schur_[part] = {slice.diagonal(separator), parts_[part].followed ? slice.upper(separator) : zero, zero};
    }
  }
  full_plan_ = plan(nodes_);
  return true;
}

// All chains are in one loop, so that the divisions of one overlap with those of the others.
template <int B>
bool SubdomainBatch<B>::eliminate_chains(const Slice<B>& slice, std::array<Front, lanes>& fronts, PivotRecord& record) {
  const bool shares = steps_ > min_steps_to_search;
  PeriodSearch search(shares ? hashes(slice) : std::vector<std::uint64_t>{});
  stored_.start(steps_);
  lower_.clear();
  inverse_.clear();
  lower_.reserve(static_cast<std::size_t>(steps_ * block_.area()));
  inverse_.reserve(static_cast<std::size_t>(steps_ * block_.triangle()));
  for (std::ptrdiff_t k = 0; k < steps_; ++k) {
    extend_store();
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (k < chain(lane).count && !eliminate_node(slice, lane, k, fronts[lane], record)) return false;
    }
    const std::ptrdiff_t p = search.period();
    const bool repeats = p > 0 && same_rows(slice, k, p) && same_pivots(slice, k, p);
    if (shares && search.repeated(k, repeats)) {
      k = repeat(slice, k + 1, p, fronts) - 1;
      search.restart(k + 1);
    }
  }
  if (shares) {
    lower_.shrink_to_fit();
    inverse_.shrink_to_fit();
  }
  return true;
}

template <int B>
void SubdomainBatch<B>::store_fill(const std::array<Front, lanes>& fronts) {
  std::size_t entries = 0;
  for (const Front& front : fronts) entries = std::max(entries, front.stored.size());
  fill_nodes_ = static_cast<std::ptrdiff_t>(entries) / block_.area();
  fill_.assign(entries, LaneEntry{});
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    for (std::size_t e = 0; e < fronts[lane].stored.size(); ++e) fill_[e].chain[lane] = fronts[lane].stored[e];
  }
}

template <int B>
TRAVERSE_FLATTEN bool SubdomainBatch<B>::eliminate_node(const Slice<B>& slice, std::size_t lane, std::ptrdiff_t k,
                                                        Front& front, PivotRecord& record) {
  Block<B> inverse = slice.diagonal(node(lane, k));
  inverse -= front.update;
  if (!invert(inverse, slice, node(lane, k), record)) return false;
  const Block<B> upper = coupling(slice, lane, k);
  const Block<B> lower = upper.transpose() * inverse;
  LaneEntry* last = lower_.data() + lower_.size() - block_.area();
  for (std::ptrdiff_t e = 0; e < block_.area(); ++e) last[e].chain[lane] = lower.data()[e];
  last = inverse_.data() + inverse_.size() - block_.triangle();
  for (int r = 0; r < block_.size(); ++r) {
    for (int c = 0; c <= r; ++c) last[packed(r, c)].chain[lane] = inverse(r, c);
  }
  front.update = lower * upper;
  if (front.has_fill) extend_fill(inverse, upper, front);
  return true;
}

template <int B>
void SubdomainBatch<B>::extend_fill(const Block<B>& inverse, const Block<B>& upper, Front& front) const {
  const Block<B> fill = front.fill * inverse;
  front.has_fill = false;
  for (std::ptrdiff_t e = 0; e < block_.area(); ++e) {
    const double size = std::abs(fill.data()[e]);
    double& peak = front.peak.data()[e];
    peak = std::max(peak, size);
    front.has_fill = front.has_fill || !(size <= negligible * peak);  // a NaN continues and is detected later
  }
  if (!front.has_fill) {
    front.fill = Block<B>(block_);
    return;
  }
  front.stored.insert(front.stored.end(), fill.data(), fill.data() + block_.area());
  front.separator += fill * front.fill.transpose();
  front.fill = -(fill * upper);
}

template <int B>
bool SubdomainBatch<B>::eliminate_middle(const Slice<B>& slice, std::size_t part, Front* fronts, PivotRecord& record) {
  const std::ptrdiff_t middle = parts_[part].middle;
  Block<B>& inverse = middle_inverse_[part];
  inverse = slice.diagonal(middle);
  for (std::size_t side : {0, 1}) inverse -= fronts[side].update;
  if (!invert(inverse, slice, middle, record)) return false;
  for (std::size_t side : {0, 1}) {
    Block<B>& fill = middle_fill_[2 * part + side];
    fill = fronts[side].fill * inverse;
    fronts[side].separator += fill * fronts[side].fill.transpose();
  }
  SchurPart<B>& schur = schur_[part];
  schur.own = -fronts[0].separator;
  if (chain(2 * part).bordered) schur.own += slice.diagonal(parts_[part].nodes.first);
  schur.coupling = -(middle_fill_[2 * part] * fronts[1].fill.transpose());
  schur.next = -fronts[1].separator;
  return true;
}

/// The chains that are processed together in a window, divided where one begins or ends and where the fill ends.
template <int B>
typename SubdomainBatch<B>::Plan SubdomainBatch<B>::plan(Range window) const {
  Plan result;
  std::array<std::ptrdiff_t, 2 * lanes + 2> cuts = {fill_nodes_, common_steps_};
  std::size_t count = 2;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const Run run = result.runs[lane] = chain(lane).run(window, parts_[lane / 2].middle);
    cuts[count++] = run.from;
    cuts[count++] = run.to;
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < count; ++i) {
    StepRange steps = {cuts[i], cuts[i + 1], 0};
    if (steps.from == steps.to) continue;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Run& run = result.runs[lane];
      if (run.from <= steps.from && steps.to <= run.to) steps.chains |= 1U << lane;
    }
    if (steps.chains != 0) result.ranges[result.count++] = steps;
  }
  return result;
}

}  // namespace traverse::solve
