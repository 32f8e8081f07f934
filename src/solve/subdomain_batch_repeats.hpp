// Stores repeating values of a batch's factors once: function bodies that blocks.hpp compiles.
#pragma once

#include <algorithm>
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

}  // namespace traverse::solve
