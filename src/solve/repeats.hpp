// Where numbers along the beam repeat, such as those of the factors on equal spans: they are kept once.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace traverse::solve {

/// Short periods are kept several times over, so that this many steps at least are read in a row.
inline constexpr std::ptrdiff_t steps_a_row = 64;

/// Fewer steps are kept whole: they stay in a cache anyway.
inline constexpr std::ptrdiff_t kept_whole = 256;

/// Adds numbers to a mark, the same for equal numbers.
template <class Numbers>
std::uint64_t mark_of(std::uint64_t mark, const Numbers& numbers) {
  for (double number : numbers) {
    mark = (mark ^ std::bit_cast<std::uint64_t>(number + 0.0)) * 0x9e3779b97f4a7c15;  // -0 as 0
    mark ^= mark >> 32;
  }
  return mark;
}

/// Steps [from, to), whose numbers are at the places from `at` on and, after `length` of them, at the same ones again.
struct Stored {
  std::ptrdiff_t from = 0;
  std::ptrdiff_t to = 0;
  std::ptrdiff_t at = 0;
  std::ptrdiff_t length = 1;
  std::ptrdiff_t place(std::ptrdiff_t k) const { return at + (k - from) % length; }
  /// The end of the steps from k on, and the first of those up to k, whose places follow one another.
  std::ptrdiff_t row_end(std::ptrdiff_t k) const { return std::min(to, k + length - (k - from) % length); }
  std::ptrdiff_t row_begin(std::ptrdiff_t k) const { return k - (k - from) % length; }
};

/// Looks for a period while steps are added one after the other. They are known by marks.
class PeriodSearch {
 public:
  explicit PeriodSearch(std::vector<std::uint64_t> marks) : marks_(std::move(marks)) {}

  std::ptrdiff_t period() const { return period_; }  // 0: none known

  /// Step k has been added; `repeats`: it is like that a period before. Whether a whole period has been.
  bool repeated(std::ptrdiff_t k, bool repeats) {
    since_ = repeats ? since_ + 1 : 0;
    if (period_ > 0 && since_ >= period_) return true;
    if (k + 1 >= next_) look(k + 1);
    return false;
  }

  /// The steps before k are settled, and that at k does not repeat: perhaps there is a longer period.
  void go_on(std::ptrdiff_t k) {
    since_ = 0;
    wait_ = first_look;
    look(k);
  }

 private:
  static constexpr std::ptrdiff_t first_look = 32;  // steps; then after twice as many, and so on
  static constexpr std::ptrdiff_t longest = 512;    // period

  // The period that has held for longest up to step k, and once at least.
  void look(std::ptrdiff_t k) {
    std::ptrdiff_t best = 0, best_steps = 0;
    for (std::ptrdiff_t p = 1; p <= std::min(longest, k / 2) && best_steps < 2 * longest; ++p) {
      const std::ptrdiff_t most = std::min(k - p, 2 * longest);
      const std::uint64_t* const end = marks_.data() + k;
      std::ptrdiff_t steps = 0;
      while (steps < most && end[-1 - steps] == end[-1 - steps - p]) ++steps;
      if (steps < p || steps <= best_steps) continue;
      best = p;
      best_steps = steps;
    }
    if (best != period_ && best > 0) {
      period_ = best;
      since_ = 0;
    }
    wait_ *= 2;
    next_ = k + wait_;
  }

  std::vector<std::uint64_t> marks_;
  std::ptrdiff_t period_ = 0;
  std::ptrdiff_t since_ = 0;  // steps in a row that repeat those a period before
  std::ptrdiff_t wait_ = first_look;
  std::ptrdiff_t next_ = first_look;
};

/// The places of steps 0, 1, ... one after the other, but for those that repeat.
class StoredSteps {
 public:
  void start(std::ptrdiff_t steps) {
    steps_ = steps;
    stored_.assign(1, {0, steps, 0, steps + 1});
  }

  const Stored& at(std::ptrdiff_t k) const {
    const auto before = [](std::ptrdiff_t step, const Stored& steps) { return step < steps.to; };
    return *std::upper_bound(stored_.begin(), stored_.end() - 1, k, before);
  }

  /// Steps [from, to) repeat those a period before, which are the last with a place. Returns how many places to add,
  /// each like that a period before it.
  std::ptrdiff_t repeat(std::ptrdiff_t from, std::ptrdiff_t to, std::ptrdiff_t period) {
    const std::ptrdiff_t begin = from - period;
    const std::ptrdiff_t copies = std::min((steps_a_row + period - 1) / period, (to - begin) / period);
    const std::ptrdiff_t place = stored_.back().place(begin);
    stored_.back().to = begin;
    if (stored_.back().from == begin) stored_.pop_back();
    stored_.push_back({begin, to, place, copies * period});
    if (to < steps_) stored_.push_back({to, steps_, place + copies * period, steps_ + 1});
    return (copies - 1) * period;
  }

  /// Settles all steps: mark(k) the same for equal ones, same(i, j) whether two are equal. Returns the step whose
  /// numbers each place is to have.
  template <class Mark, class Same>
  std::vector<std::ptrdiff_t> keep(std::ptrdiff_t steps, Mark mark, Same same) {
    start(steps);
    std::vector<std::ptrdiff_t> kept;
    std::vector<std::uint64_t> marks;
    if (steps > kept_whole) {
      for (std::ptrdiff_t k = 0; k < steps; ++k) marks.push_back(mark(k));
    }
    PeriodSearch search(std::move(marks));
    for (std::ptrdiff_t k = 0; k < steps; ++k) {
      kept.push_back(k);
      const std::ptrdiff_t p = search.period();
      if (steps <= kept_whole || !search.repeated(k, p > 0 && same(k, k - p))) continue;
      std::ptrdiff_t to = k + 1;
      while (to < steps && same(to, to - p)) ++to;
      if (to - (k + 1) >= p) {
        for (std::ptrdiff_t more = repeat(k + 1, to, p); more > 0; --more) kept.push_back(kept.end()[-p]);
        k = to - 1;
      }
      search.go_on(k + 1);
    }
    return kept;
  }

 private:
  std::vector<Stored> stored_;
  std::ptrdiff_t steps_ = 0;
};

}  // namespace traverse::solve
