// Follows the ends of steps; samples without a stop between them are counted together.
#include "integrate/step_count.hpp"

#include <algorithm>
#include <cmath>

#include "integrate/step_size_control.hpp"

namespace traverse::integrate {
namespace {

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
