#include "run/wheel_extremes.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::app {
namespace {

// Of two neighbouring steps, the longer over the shorter: beyond it a contact was lost or gained between them, or the
// short one says more of rounding than of the slope.
constexpr double alike = 4.0;

}  // namespace

WheelExtremes::WheelExtremes(std::size_t wheels, std::vector<double> kinks)
    : seen_(wheels), at_start_(wheels, 0.0), kinks_(std::move(kinks)) {}

void WheelExtremes::note(double force, double time, std::size_t wheel) {
  if (force < least_.force) least_ = {force, time, static_cast<int>(wheel)};
  if (force > greatest_.force) greatest_ = {force, time, static_cast<int>(wheel)};
  if (at_start_[wheel] > 0.0) unloading_.note(std::max(0.0, 1.0 - force / at_start_[wheel]), time, wheel);
}

void WheelExtremes::add(std::size_t wheel, double t, double x, double force) {
  Seen& seen = seen_[wheel];
  if (seen.count > 0 && t <= seen.time[2]) return;
  seen.time = {seen.time[1], seen.time[2], t};
  seen.x = {seen.x[1], seen.x[2], x};
  seen.force = {seen.force[1], seen.force[2], force};
  note(force, t, wheel);
  if (at_start_[wheel] <= 0.0) at_start_[wheel] = force;
  if (++seen.count >= 3) look_between(seen, wheel);
}

// The vertex of the parabola through three instants of which the middle one is extreme. In flight the force is zero and
// has corners at both ends.
void WheelExtremes::look_between(const Seen& seen, std::size_t wheel) {
  const auto &t = seen.time, &x = seen.x, &f = seen.force;
  const double before = t[1] - t[0], after = t[2] - t[1];
  const bool extreme = (f[1] - f[0]) * (f[2] - f[1]) <= 0.0 && f[1] != f[2];
  if (!extreme || std::max(before, after) > alike * std::min(before, after)) return;
  if (f[0] <= 0.0 || f[1] <= 0.0 || f[2] <= 0.0) return;
  const auto [from, to] = std::minmax(x[0], x[2]);
  const auto kink = std::lower_bound(kinks_.begin(), kinks_.end(), from);
  if (kink != kinks_.end() && *kink <= to) return;
  const double rise = (f[1] - f[0]) / before, fall = (f[2] - f[1]) / after;
  const double slope = (rise * after + fall * before) / (before + after), bend = (fall - rise) / (before + after);
  const double shift = -0.5 * slope / bend;
  note(std::max(f[1] + 0.5 * slope * shift, 0.0), t[1] + shift, wheel);
}

}  // namespace traverse::app
