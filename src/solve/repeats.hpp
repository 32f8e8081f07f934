// Detection of repeating values along the beam, such as the factors on equal spans, and their storage only once. Here
// a step is the elimination of one node of a chain (subdomain_batch.hpp). A step
// here is one item of a sequence along the beam: a node, or one elimination of a factorisation.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace traverse::solve {

/// Short periods are stored several times, so that at least this number of steps is consecutive in memory.
inline constexpr std::ptrdiff_t min_consecutive_steps = 64;

/// Sequences with at most this number of steps are stored completely: they fit into a cache.
inline constexpr std::ptrdiff_t min_steps_to_search = 256;

/// Adds numbers to a hash, which is equal for equal numbers.
template <class Numbers>
std::uint64_t hash_of(std::uint64_t hash, const Numbers& numbers) {
  for (double number : numbers) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(number + 0.0)) * 0x9e3779b97f4a7c15;  // -0 as 0
    hash ^= hash >> 32;
  }
  return hash;
}

/// Steps [from, to) whose values have the storage indices from `at` on and repeat after `length` indices.
struct Stored {
  std::ptrdiff_t from = 0;
  std::ptrdiff_t to = 0;
  std::ptrdiff_t at = 0;
  std::ptrdiff_t length = 1;
  std::ptrdiff_t storage_index(std::ptrdiff_t k) const { return at + (k - from) % length; }
  /// The end of the steps with consecutive storage indices from k on, and the first step with consecutive storage
  /// indices up to k.
  std::ptrdiff_t row_end(std::ptrdiff_t k) const { return std::min(to, k + length - (k - from) % length); }
  std::ptrdiff_t row_begin(std::ptrdiff_t k) const { return k - (k - from) % length; }
};

/// Searches for a period while steps are added one by one. Hashes identify the steps.
class PeriodSearch {
 public:
  explicit PeriodSearch(std::vector<std::uint64_t> hashes) : hashes_(std::move(hashes)) {}

  std::ptrdiff_t period() const { return period_; }  // 0: none found

  /// Adds step k; `repeats`: it equals the step one period before. Returns whether a whole period has repeated.
  bool repeated(std::ptrdiff_t k, bool repeats) {
    repeated_steps_ = repeats ? repeated_steps_ + 1 : 0;
    if (period_ > 0 && repeated_steps_ >= period_) return true;
    if (k + 1 >= next_) search(k + 1);
    return false;
  }

  /// The steps before k are stored, and step k does not repeat: searches for another, longer period.
  void restart(std::ptrdiff_t k) {
    repeated_steps_ = 0;
    interval_ = first_search;
    search(k);
  }

 private:
  static constexpr std::ptrdiff_t first_search = 32;  // steps; the next searches are after twice as many, and so on
  static constexpr std::ptrdiff_t longest = 512;      // period

  // Sets the period that has repeated for the largest number of steps up to step k, and at least once.
  void search(std::ptrdiff_t k) {
    std::ptrdiff_t best = 0, best_steps = 0;
    for (std::ptrdiff_t p = 1; p <= std::min(longest, k / 2) && best_steps < 2 * longest; ++p) {
      const std::ptrdiff_t most = std::min(k - p, 2 * longest);
      const std::uint64_t* const end = hashes_.data() + k;
      std::ptrdiff_t steps = 0;
      while (steps < most && end[-1 - steps] == end[-1 - steps - p]) ++steps;
      if (steps < p || steps <= best_steps) continue;
      best = p;
      best_steps = steps;
    }
    if (best != period_ && best > 0) {
      period_ = best;
      repeated_steps_ = 0;
    }
    interval_ *= 2;
    next_ = k + interval_;
  }

  std::vector<std::uint64_t> hashes_;
  std::ptrdiff_t period_ = 0;
  std::ptrdiff_t repeated_steps_ = 0;  // consecutive steps that equal those a period before
  std::ptrdiff_t interval_ = first_search;
  std::ptrdiff_t next_ = first_search;
};

/// The storage indices of steps 0, 1, ...: consecutive, except for steps that repeat.
class StoredSequence {
 public:
  void start(std::ptrdiff_t steps) {
    steps_ = steps;
    stored_.assign(1, {0, steps, 0, steps + 1});
  }

  const Stored& at(std::ptrdiff_t k) const {
    const auto before = [](std::ptrdiff_t step, const Stored& steps) { return step < steps.to; };
    return *std::upper_bound(stored_.begin(), stored_.end() - 1, k, before);
  }

  /// Records that steps [from, to) repeat those a period before, which are the last stored ones. Returns the number
  /// of values to append, each a copy of the value a period before it.
  std::ptrdiff_t repeat(std::ptrdiff_t from, std::ptrdiff_t to, std::ptrdiff_t period) {
    const std::ptrdiff_t begin = from - period;
    const std::ptrdiff_t copies = std::min((min_consecutive_steps + period - 1) / period, (to - begin) / period);
    const std::ptrdiff_t storage_index = stored_.back().storage_index(begin);
    stored_.back().to = begin;
    if (stored_.back().from == begin) stored_.pop_back();
    stored_.push_back({begin, to, storage_index, copies * period});
    if (to < steps_) stored_.push_back({to, steps_, storage_index + copies * period, steps_ + 1});
    return (copies - 1) * period;
  }

  /// Assigns storage indices to all steps: hash(k) is equal for equal steps, same(i, j) compares two steps. Returns for
  /// each storage index the step whose values it has.
  template <class Hash, class Same>
  std::vector<std::ptrdiff_t> assign(std::ptrdiff_t steps, Hash hash, Same same) {
    start(steps);
    std::vector<std::ptrdiff_t> sources;
    std::vector<std::uint64_t> hashes;
    if (steps > min_steps_to_search) {
      for (std::ptrdiff_t k = 0; k < steps; ++k) hashes.push_back(hash(k));
    }
    PeriodSearch search(std::move(hashes));
    for (std::ptrdiff_t k = 0; k < steps; ++k) {
      sources.push_back(k);
      const std::ptrdiff_t p = search.period();
      if (steps <= min_steps_to_search || !search.repeated(k, p > 0 && same(k, k - p))) continue;
      std::ptrdiff_t to = k + 1;
      while (to < steps && same(to, to - p)) ++to;
      if (to - (k + 1) >= p) {
        for (std::ptrdiff_t missing = repeat(k + 1, to, p); missing > 0; --missing)
          sources.push_back(sources.end()[-p]);
        k = to - 1;
      }
      search.restart(k + 1);
    }
    return sources;
  }

 private:
  std::vector<Stored> stored_;
  std::ptrdiff_t steps_ = 0;
};

}  // namespace traverse::solve
