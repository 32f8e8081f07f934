// Extremes of the normal force between steps by interpolation of the last samples, without those where the wheel is in
// flight or passes a kink of the surface.
#include "run/wheel_extremes.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::app {

WheelExtremes::WheelExtremes(std::size_t wheels, std::vector<double> kinks)
    : seen_(wheels), at_start_(wheels, 0.0), kinks_(std::move(kinks)) {}

void WheelExtremes::note(double force, double time, std::size_t wheel) {
  if (force < least_.value) least_ = {force, time, wheel};
  greatest_.raise(force, time, wheel);
  if (at_start_[wheel] > 0.0) unloading_.raise(std::max(0.0, 1.0 - force / at_start_[wheel]), time, wheel);
}

void WheelExtremes::add(std::size_t wheel, double t, double x, double force) {
  Seen& seen = seen_[wheel];
  if (seen.force.count > 0 && t <= seen.force.time.back()) return;
  seen.force.push(t, force);
  std::rotate(seen.x.begin(), seen.x.begin() + 1, seen.x.end());
  seen.x.back() = x;
  note(force, t, wheel);
  if (at_start_[wheel] <= 0.0) at_start_[wheel] = force;
  if (seen.force.count >= 4) look(seen, 2, wheel);
}

void WheelExtremes::finish() {
  for (std::size_t wheel = 0; wheel < seen_.size(); ++wheel)
    if (seen_[wheel].force.count >= 3) look(seen_[wheel], 3, wheel);
}

// In flight the force is zero and has corners at both ends.
bool WheelExtremes::smooth(const Seen& seen, std::size_t i, std::size_t j) const {
  for (std::size_t k = i; k <= j; ++k)
    if (seen.force.value[k] <= 0.0) return false;
  const auto [from, to] = std::minmax(seen.x[i], seen.x[j]);
  const auto kink = std::lower_bound(kinks_.begin(), kinks_.end(), from);
  return kink == kinks_.end() || *kink > to;
}

void WheelExtremes::look(const Seen& seen, std::size_t i, std::size_t wheel) {
  const auto& f = seen.force.value;
  if ((f[i] - f[i - 1]) * (f[i + 1] - f[i]) > 0.0 || f[i] == f[i + 1]) return;
  const Extreme turn =
      turn_about(seen.force, i, [&](std::size_t from, std::size_t to) { return smooth(seen, from, to); });
  note(std::max(turn.value, 0.0), turn.time, wheel);
}

}  // namespace traverse::app
