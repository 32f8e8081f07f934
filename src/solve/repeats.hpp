// Where the numbers of a bundle's factors repeat. On equal spans the pivot blocks of a chain tend to a period of one
// span, and reach it within some ten spans to the last digits: from there on they are kept once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace traverse::solve {

/// Steps [from, to) of a bundle's chains, whose numbers are at the places from `at` on and, after `length` of them, at
/// the same ones again.
struct Stored {
  std::ptrdiff_t from = 0;
  std::ptrdiff_t to = 0;
  std::ptrdiff_t at = 0;
  std::ptrdiff_t length = 1;
  std::ptrdiff_t place(std::ptrdiff_t k) const { return at + (k - from) % length; }
  /// The last of the steps from k on, and the first of those up to k, whose places follow one another.
  std::ptrdiff_t row_end(std::ptrdiff_t k) const { return std::min(to, k + length - (k - from) % length); }
  std::ptrdiff_t row_begin(std::ptrdiff_t k) const { return k - (k - from) % length; }
};

/// Looks for a period while a bundle is being factored. Steps are known by marks, the same for steps of equal rows.
class PeriodSearch {
 public:
  explicit PeriodSearch(std::vector<std::uint64_t> marks) : marks_(std::move(marks)) {}

  std::ptrdiff_t period() const { return period_; }  // 0: none known

  /// Step k has been eliminated; `repeats`: its rows and numbers are those of a period before. Whether those of a whole
  /// period have been.
  bool repeated(std::ptrdiff_t k, bool repeats) {
    since_ = repeats ? since_ + 1 : 0;
    if (period_ > 0 && since_ >= period_) return true;
    if (k + 1 >= next_) look(k + 1);
    return false;
  }

  /// Steps before k are settled.
  void go_on(std::ptrdiff_t k) {
    since_ = 0;
    wait_ = first_look;
    next_ = k + wait_;
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

}  // namespace traverse::solve
