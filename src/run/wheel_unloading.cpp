// Unloading 1 - F/F_0 of each wheel after a Butterworth low-pass filter, and the longest time above a chosen level by
// linear interpolation between samples. Extremes of the normal force between steps by interpolation of the last
// samples, except where the wheel is in flight or passes a kink of the surface.
#include "run/wheel_unloading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "run/deck_acceleration.hpp"
#include "run/low_pass.hpp"
#include "run/response_extremes.hpp"

namespace traverse::run {
namespace {

constexpr double interval_tolerance = 1e-6;  // relative tolerance of a multiple of the interval

/// The longest range of a series above a level, by linear interpolation, in intervals.
struct RangeAbove {
  double length = 0.0, from = 0.0;
};

template <class Value>
RangeAbove longest_above(double level, std::size_t instants, const Value& value) {
  RangeAbove longest;
  double from = 0.0;
  bool above = instants > 0 && value(0) > level;
  const auto end = [&](double at) {
    if (at - from > longest.length) longest = {at - from, from};
  };
  for (std::size_t k = 1; k < instants; ++k) {
    const double before = value(k - 1), present = value(k);
    if (above == (present > level)) continue;
    const double crossing = static_cast<double>(k - 1) + (level - before) / (present - before);
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

bool filters_wheels(const scene::Scene& scene) {
  const bool limited = scene.limits_quantity("filtered_wheel_unloading") || scene.limits_quantity("unloading_time");
  const bool has_wheels = std::any_of(scene.vehicles.begin(), scene.vehicles.end(),
                                      [](const train::Vehicle& vehicle) { return !vehicle.wheels.empty(); });
  return has_wheels && (limited || scene.output.wheels_filtered) && scene.analysis == options::Analysis::transient &&
         scene.start == scene::Start::equilibrium;
}

FilteredWheels::FilteredWheels(double frequency, double level, const Plan& plan, std::size_t wheels)
    : frequency_(frequency), level_(level), interval_(plan.interval), wheels_(wheels) {
  rows_.reserve(wheels * static_cast<std::size_t>(2.0 + plan.end_time / plan.interval));
}

bool FilteredWheels::is_due(double t) const {
  const std::size_t instants = rows_.size() / wheels_;
  const double next = static_cast<double>(instants) * interval_;
  return std::abs(t - next) <= interval_tolerance * interval_;
}

results::FilteredUnloading FilteredWheels::finish(const train::Fleet& fleet) {
  const std::vector<double> at_start(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(wheels_));
  rows_.resize(wheels_ * std::max<std::size_t>(1, filter(rows_, wheels_, frequency_, interval_)));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double initial = at_start[i % wheels_];
    rows_[i] = initial > 0.0 ? std::max(0.0, 1.0 - rows_[i] / initial) : 0.0;
  }
  const Extreme largest = largest_peak(rows_, wheels_, interval_);

  results::FilteredUnloading result;
  result.extreme = {largest.value, largest.time, wheel_name(fleet, static_cast<std::size_t>(largest.place))};
  result.frequency = frequency_;
  result.interval = interval_;
  result.filter = low_pass_name;
  result.level = level_;
  for (std::size_t wheel = 0; wheel < wheels_; ++wheel) {
    const RangeAbove range =
        longest_above(level_, rows_.size() / wheels_, [&](std::size_t k) { return rows_[k * wheels_ + wheel]; });
    if (range.length * interval_ <= result.longest) continue;
    result.longest = range.length * interval_;
    result.longest_from = range.from * interval_;
    result.longest_wheel = wheel_name(fleet, wheel);
  }
  return result;
}

WheelExtremes::WheelExtremes(std::size_t wheels, std::vector<double> kinks)
    : latest_(wheels), at_start_(wheels, 0.0), extremes_(wheels), kinks_(std::move(kinks)) {}

void WheelExtremes::record(double force, double time, std::size_t wheel) {
  Extremes& of_wheel = extremes_[wheel];
  if (force < of_wheel.least.value) of_wheel.least = {force, time, wheel};
  of_wheel.greatest.raise(force, time, wheel);
  if (at_start_[wheel] > 0.0) of_wheel.unloading.raise(std::max(0.0, 1.0 - force / at_start_[wheel]), time, wheel);
}

WheelExtremes::Extremes WheelExtremes::of(std::size_t first, std::size_t past) const {
  const auto earlier = [](const Extreme& one, const Extreme& other) {
    return one.value == other.value && one.time < other.time;
  };
  Extremes all;
  for (std::size_t wheel = first; wheel < past; ++wheel) {
    const Extremes& one = extremes_[wheel];
    if (one.least.value < all.least.value || earlier(one.least, all.least)) all.least = one.least;
    if (one.greatest.value > all.greatest.value || earlier(one.greatest, all.greatest)) all.greatest = one.greatest;
    if (one.unloading.value > all.unloading.value || earlier(one.unloading, all.unloading))
      all.unloading = one.unloading;
  }
  return all;
}

void WheelExtremes::add(std::size_t wheel, double t, double x, double force) {
  Latest& latest = latest_[wheel];
  if (latest.force.count > 0 && t <= latest.force.time.back()) return;
  latest.force.push(t, force);
  std::rotate(latest.x.begin(), latest.x.begin() + 1, latest.x.end());
  latest.x.back() = x;
  record(force, t, wheel);
  if (at_start_[wheel] <= 0.0) at_start_[wheel] = force;
  if (latest.force.count >= 4) evaluate(latest, 2, wheel);
}

void WheelExtremes::finish() {
  for (std::size_t wheel = 0; wheel < latest_.size(); ++wheel)
    if (latest_[wheel].force.count >= 3) evaluate(latest_[wheel], 3, wheel);
}

// In flight the force is zero and has kinks at both ends.
bool WheelExtremes::smooth(const Latest& latest, std::size_t i, std::size_t j) const {
  for (std::size_t k = i; k <= j; ++k)
    if (latest.force.value[k] <= 0.0) return false;
  const auto [from, to] = std::minmax(latest.x[i], latest.x[j]);
  const auto kink = std::lower_bound(kinks_.begin(), kinks_.end(), from);
  return kink == kinks_.end() || *kink > to;
}

void WheelExtremes::evaluate(const Latest& latest, std::size_t i, std::size_t wheel) {
  const auto& f = latest.force.value;
  if ((f[i] - f[i - 1]) * (f[i + 1] - f[i]) > 0.0 || f[i] == f[i + 1]) return;
  const Extreme extremum =
      interpolate_extremum(latest.force, i, [&](std::size_t from, std::size_t to) { return smooth(latest, from, to); });
  record(std::max(extremum.value, 0.0), extremum.time, wheel);
}

}  // namespace traverse::run
