// Unloading 1 - F/F_0 of each wheel after a Butterworth low-pass filter, and the longest time above a chosen level by
// linear interpolation between samples.
#include "run/wheel_unloading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "run/low_pass.hpp"
#include "run/response_extremes.hpp"

namespace traverse::app {
namespace {

constexpr double at_an_interval = 1e-6;  // of it: an instant that is a multiple

/// The longest stretch of a series that stays above a level, by straight lines between its instants, in intervals.
struct Stretch {
  double length = 0.0, from = 0.0;
};

template <class Value>
Stretch longest_above(double level, std::size_t instants, const Value& value) {
  Stretch longest;
  double from = 0.0;
  bool above = instants > 0 && value(0) > level;
  const auto end = [&](double at) {
    if (at - from > longest.length) longest = {at - from, from};
  };
  for (std::size_t k = 1; k < instants; ++k) {
    const double before = value(k - 1), now = value(k);
    if (above == (now > level)) continue;
    const double crossing = static_cast<double>(k - 1) + (level - before) / (now - before);
    if (above)
      end(crossing);
    else
      from = crossing;
    above = !above;
  }
  if (above) end(static_cast<double>(instants) - 1.0);
  return longest;
}

}  // namespace

std::string wheel_name(const train::Fleet& fleet, std::size_t wanted) {
  std::size_t wheel = 0;
  for (std::size_t i = 0; i < fleet.wheels.size(); ++i) {
    const train::WheelContact& c = fleet.wheels[i];
    if (!c.is_further && wheel++ == wanted)
      return fmt::format("vehicle {}, {}", fleet.member(static_cast<int>(i)), fleet.wheel(c).name);
  }
  return "";
}

bool filters_wheels(const Scene& scene) {
  const bool limited = std::any_of(scene.limits.begin(), scene.limits.end(), [](const options::VerdictLimit& limit) {
    return limit.quantity == "filtered_wheel_unloading" || limit.quantity == "unloading_time";
  });
  const bool rolls = std::any_of(scene.vehicles.begin(), scene.vehicles.end(),
                                 [](const Vehicle& vehicle) { return !vehicle.wheels.empty(); });
  return rolls && (limited || scene.output.wheels_filtered) && scene.analysis == Analysis::transient &&
         scene.start == Start::equilibrium;
}

FilteredWheels::FilteredWheels(double frequency, double level, const Plan& plan, std::size_t wheels)
    : frequency_(frequency), level_(level), interval_(plan.interval), wheels_(wheels) {
  kept_.reserve(wheels * static_cast<std::size_t>(2.0 + plan.end_time / plan.interval));
}

bool FilteredWheels::wants(double t) const {
  const std::size_t instants = kept_.size() / wheels_;
  const double due = static_cast<double>(instants) * interval_;
  return std::abs(t - due) <= at_an_interval * interval_;
}

results::FilteredUnloading FilteredWheels::finish(const train::Fleet& fleet) {
  const std::vector<double> at_start(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(wheels_));
  LowPass(frequency_, interval_).apply(kept_, wheels_);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const double rest = at_start[i % wheels_];
    kept_[i] = rest > 0.0 ? std::max(0.0, 1.0 - kept_[i] / rest) : 0.0;
  }
  const Extreme largest = largest_peak(kept_, wheels_, interval_);

  results::FilteredUnloading found;
  found.extreme = {largest.value, largest.time, wheel_name(fleet, static_cast<std::size_t>(largest.place))};
  found.frequency = frequency_;
  found.interval = interval_;
  found.filter = low_pass_name;
  found.level = level_;
  for (std::size_t wheel = 0; wheel < wheels_; ++wheel) {
    const Stretch stretch =
        longest_above(level_, kept_.size() / wheels_, [&](std::size_t k) { return kept_[k * wheels_ + wheel]; });
    if (stretch.length * interval_ <= found.longest) continue;
    found.longest = stretch.length * interval_;
    found.longest_from = stretch.from * interval_;
    found.longest_wheel = wheel_name(fleet, wheel);
  }
  return found;
}

}  // namespace traverse::app
