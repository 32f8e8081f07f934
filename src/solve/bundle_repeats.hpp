// Keeps the numbers of a bundle's factors once where they repeat: the bodies of Bundle<B> that blocks.hpp compiles.
#pragma once

#include <algorithm>
#include <bit>
#include <limits>

#include "bundle.hpp"

namespace traverse::solve {

// Chains of fewer steps are kept whole: they stay in a cache anyway.
inline constexpr std::ptrdiff_t kept_whole = 256;

// Short periods are kept several times over, so that this many steps at least are swept in a row.
inline constexpr std::ptrdiff_t steps_a_row = 64;

// Largest difference of two entries of inverse pivot blocks that are taken to be the same, relative to the root of the
// product of their diagonal entries.
inline constexpr double same_pivot = 4.0 * std::numeric_limits<double>::epsilon();

/// Couples a chain's node k (rows) to the next (columns).
template <int B>
Block<B> Bundle<B>::coupling(const Slice<B>& slice, std::size_t lane, std::ptrdiff_t k) const {
  const std::ptrdiff_t here = node(lane, k);
  return chain(lane).direction > 0 ? slice.upper(here) : slice.upper(here - 1).transpose();
}

template <int B>
Block<B> Bundle<B>::stored_inverse(std::size_t lane, std::ptrdiff_t k) const {
  const LaneEntry* from = inverse_.data() + stored(k).place(k) * block_.triangle();
  Block<B> result(block_);
  for (int c = 0; c < block_.size(); ++c) {
    for (int r = 0; r < block_.size(); ++r) result(r, c) = from[packed(r, c)].chain[lane];
  }
  return result;
}

/// A number for each step, the same for steps with the same rows in all chains.
template <int B>
std::vector<std::uint64_t> Bundle<B>::marks(const Slice<B>& slice) const {
  std::vector<std::uint64_t> result(static_cast<std::size_t>(steps_), 0);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    for (std::ptrdiff_t k = 0; k < chain(lane).count; ++k) {
      std::uint64_t& mark = result[static_cast<std::size_t>(k)];
      for (const Block<B>& block : {slice.diagonal(node(lane, k)), coupling(slice, lane, k)}) {
        for (std::ptrdiff_t e = 0; e < block_.area(); ++e) {
          mark = (mark ^ std::bit_cast<std::uint64_t>(block.data()[e] + 0.0)) * 0x9e3779b97f4a7c15;  // -0 as 0
          mark ^= mark >> 32;
        }
      }
    }
  }
  return result;
}

template <int B>
bool Bundle<B>::same_rows(const Slice<B>& slice, std::ptrdiff_t k, std::ptrdiff_t period) const {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (k >= chain(lane).count) continue;
    const std::ptrdiff_t now = node(lane, k), before = node(lane, k - period);
    const std::ptrdiff_t to_next = chain(lane).direction > 0 ? 0 : 1;
    if (!slice.same_diagonal(now, before) || !slice.same_upper(now - to_next, before - to_next)) return false;
  }
  return true;
}

/// To rounding. The rows being the same, so are then the other numbers.
template <int B>
bool Bundle<B>::same_pivots(std::ptrdiff_t k, std::ptrdiff_t period) const {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (k >= chain(lane).count) continue;
    const Block<B> now = stored_inverse(lane, k), before = stored_inverse(lane, k - period);
    for (int c = 0; c < block_.size(); ++c) {
      for (int r = c; r < block_.size(); ++r) {
        const double change = now(r, c) - before(r, c);
        if (change * change > same_pivot * same_pivot * now(r, r) * now(c, c)) return false;
      }
    }
  }
  return true;
}

/// The steps from `from` on, as far as their rows repeat, take the numbers of the period before. Returns the first that
/// does not.
template <int B>
std::ptrdiff_t Bundle<B>::repeat(const Slice<B>& slice, std::ptrdiff_t from, std::ptrdiff_t period,
                                 std::array<Front, lanes>& fronts) {
  std::ptrdiff_t to = from;
  while (to < steps_ && same_rows(slice, to, period)) ++to;
  if (to - from < period) return from;
  const std::ptrdiff_t begin = from - period;
  const std::ptrdiff_t copies = std::min((steps_a_row + period - 1) / period, (to - begin) / period);
  const std::ptrdiff_t place = stored_.back().place(begin);
  stored_.back().to = begin;
  if (stored_.back().from == begin) stored_.pop_back();
  stored_.push_back({begin, to, place, copies * period});
  for (std::ptrdiff_t step = period; step < copies * period; ++step) {
    extend_store();
    std::copy_n(lower_.end() - (period + 1) * block_.area(), block_.area(), lower_.end() - block_.area());
    std::copy_n(inverse_.end() - (period + 1) * block_.triangle(), block_.triangle(), inverse_.end() - block_.triangle());
  }
  if (to < steps_) stored_.push_back({to, steps_, place + copies * period, steps_ + 1});
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const std::ptrdiff_t past = std::min(to, chain(lane).count);
    for (std::ptrdiff_t k = from; k < past && fronts[lane].filling; ++k) {
      extend_fill(stored_inverse(lane, k), coupling(slice, lane, k), fronts[lane]);
    }
    if (past <= from) continue;
    const Block<B> last = coupling(slice, lane, past - 1);
    fronts[lane].update = last.transpose() * stored_inverse(lane, past - 1) * last;
  }
  return to;
}

}  // namespace traverse::solve
