// Selects the next step length longest/2^k from the local error estimate of an embedded method: at once shorter if the
// error is too large, twice as long after two accurate steps. To count steps, the ends of steps are followed; samples
// without a stop between them are counted together.
#include "integrate/step_size_control.hpp"

#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"

namespace traverse::integrate {
namespace {

constexpr int most_levels = 1000;           // limit of the levels that other conditions need
constexpr int last_level = 16;              // level of the shortest step due to errors
constexpr int most_levels_at_once = 4;      // limit of the change of the level at once
constexpr double growth = 16.0;             // growth of the error per level: local errors are of order 4
constexpr double target = 0.5;              // wanted error on another level, relative to the tolerance
constexpr int required_accurate_steps = 2;  // number of accurate steps before a longer step
constexpr double same_step = 1e-6;          // lengths of steps that differ relatively by less are equal
constexpr double rounding = 1e-9;           // rounding of times, relative to a step

constexpr double same_end = 1e-3;     // of a step or an interval: closer ends are one
constexpr double same_length = 1e-7;  // relative difference of lengths that share a factorisation

/// The lengths of the latest steps, the last one first.
class Lengths {
 public:
  explicit Lengths(std::size_t stored) : stored_(stored) {}
  /// Whether the length is a new one.
  bool add(double length) {
    const auto known = std::find_if(latest_.begin(), latest_.end(),
                                    [&](double one) { return std::abs(one - length) <= same_length * length; });
    const bool found = known != latest_.end();
    if (found) latest_.erase(known);
    latest_.insert(latest_.begin(), length);
    if (latest_.size() > stored_) latest_.pop_back();
    return !found;
  }

 private:
  std::size_t stored_;
  std::vector<double> latest_;
};

}  // namespace

double shared_evenly(double whole, double most) {
  return whole / std::max(1.0, std::ceil(whole / most * (1.0 - rounding)));
}

double StepSizeControl::length(int level) const { return std::ldexp(longest_, -level); }

// The first level with a length of at most `most`.
int StepSizeControl::level_within(double most) const {
  if (!std::isfinite(most)) return 0;
  return std::max(0, base::whole(std::ceil(std::log2(longest_ / most * (1.0 - rounding))), most_levels));
}

bool StepSizeControl::evaluate(double h, double error) {
  if (!(error <= 1.0) && h > length(last_level) * (1.0 + same_step)) {
    int level = level_within(h * (1.0 - same_step));
    const int last = std::min(last_level, level + most_levels_at_once - 1);
    while (level < last && !(error * std::pow(length(level) / h, std::log2(growth)) <= target)) ++level;
    level_ = std::max(level, level_);
    accurate_steps_ = 0;
    return false;
  }
  if (h < allowed_step() * (1.0 - same_step))
    return true;  // a shorter step does not show whether a longer one is accurate
  accurate_steps_ = error * growth <= target ? accurate_steps_ + 1 : 0;
  if (level_ > 0 && accurate_steps_ >= required_accurate_steps) {
    --level_;
    accurate_steps_ = 0;
  }
  return true;
}

double StepSizeControl::next_step(double remaining, double most) const {
  const int first = std::max(level_, level_within(most));
  for (int level = first; level <= std::max(first, last_level); ++level) {
    const double count = std::round(remaining / length(level));
    if (count >= 1.0 && std::abs(remaining - count * length(level)) <= same_step * length(level))
      return count == 1.0 ? remaining : length(level);
  }
  const double h = length(first);
  if (remaining <= h) return remaining;
  return remaining < 2.0 * h ? 0.5 * remaining : h;
}

StepCount count_steps(double end, double interval, double longest, const std::vector<double>& stops,
                      std::size_t stored) {
  StepCount count;
  Lengths lengths(stored);
  const double slack = same_end * std::min({longest, interval, end});
  const auto add = [&](double duration, double times) {
    const double length = shared_evenly(duration, longest);
    count.steps += times * std::round(duration / length);
    if (lengths.add(length)) ++count.lengths;
  };
  auto stop = stops.begin();
  double samples = 0.0;
  for (double t = 0.0; t < end - slack;) {
    while (stop != stops.end() && *stop <= t + slack) ++stop;
    const double next_stop = stop != stops.end() ? std::min(*stop, end) : end, sample = samples * interval;
    const double whole = std::floor((next_stop - sample) / interval + same_end);
    if (t == sample && whole >= 1.0) {
      add(interval, whole);
      samples += whole;
      t = samples * interval;
      continue;
    }
    double target = std::min(next_stop, (samples + 1.0) * interval);
    if (target > (samples + 1.0) * interval - slack) target = ++samples * interval;
    add(target - t, 1.0);
    t = target;
  }
  return count;
}

}  // namespace traverse::integrate
