// Extremes of the normal force between steps by interpolation of the last samples, except where the wheel is in flight
// or passes a kink of the surface.
#include "run/wheel_extremes.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::run {

WheelExtremes::WheelExtremes(std::size_t wheels, std::vector<double> kinks)
    : latest_(wheels), at_start_(wheels, 0.0), kinks_(std::move(kinks)) {}

void WheelExtremes::record(double force, double time, std::size_t wheel) {
  if (force < least_.value) least_ = {force, time, wheel};
  greatest_.raise(force, time, wheel);
  if (at_start_[wheel] > 0.0) unloading_.raise(std::max(0.0, 1.0 - force / at_start_[wheel]), time, wheel);
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
