// Cubic Hermite interpolation of the penetration between two accepted states. Its roots are the times at which a
// contact opens or closes; its maximum determines the force of an impact.
#include "train/separations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::train {
namespace {

/// The cubic through two values with their slopes, on [0, 1].
struct Cubic {
  double a, b, c, d;  // a + b s + c s^2 + d s^3
  Cubic(double from, double slope, double to, double end_slope)
      : a(from), b(slope), c(3.0 * (to - from) - 2.0 * slope - end_slope), d(2.0 * (from - to) + slope + end_slope) {}
  double at(double s) const { return a + s * (b + s * (c + s * d)); }

  /// A root in [low, high], where the cubic has different signs at the ends.
  double root(double low, double high) const {
    const bool rises = at(high) > 0.0;
    for (int i = 0; i < 60; ++i) {
      const double s = 0.5 * (low + high);
      ((at(s) > 0.0) == rises ? high : low) = s;
    }
    return high;
  }
  /// The extremum in (0, 1) that is farthest in the direction of `sign`.
  std::optional<double> extreme(double sign) const {
    std::optional<double> best;
    const double discriminant = c * c - 3.0 * d * b;
    if (discriminant < 0.0) return best;
    const double q = -(c + std::copysign(std::sqrt(discriminant), c));
    for (const double s : {q / (3.0 * d), b / q}) {
      if (!(s > 0.0 && s < 1.0)) continue;
      if (!best || sign * at(s) > sign * at(*best)) best = s;
    }
    return best;
  }
};

/// The penetration between two instants.
Cubic penetration(const contact::Kinematics& low, const contact::Kinematics& high, double h) {
  return {low.penetration, h * low.penetration_rate, high.penetration, h * high.penetration_rate};
}

}  // namespace

double Separations::change_between(const Fleet& fleet, int contact, double t_low, const contact::Kinematics& low,
                                   double t_high, const contact::Kinematics& high) const {
  const Contact& c = fleet.contact(contact);
  const double h = t_high - t_low;
  const bool by_force =
      low.penetration > 0.0 && high.penetration > 0.0;  // a damper opens the contact while it is compressed
  if (by_force) {
    const double from = contact::unlimited_normal_force(c.law, low, c.approach_speed);
    const double to = contact::unlimited_normal_force(c.law, high, c.approach_speed);
    return from == to ? t_high : t_low + h * std::clamp(from / (from - to), 0.0, 1.0);
  }
  return t_low + h * penetration(low, high, h).root(0.0, 1.0);
}

double Separations::time_to_touch(int contact) const {
  const ContactState& state = states_[contact];
  const auto& [penetration, rate, sliding] = state.kinematics;
  return state.touching || !(rate > 0.0) ? std::numeric_limits<double>::infinity() : std::max(-penetration, 0.0) / rate;
}

std::optional<Change> Separations::change(const Fleet& fleet, double t,
                                          const std::function<bool(int)>& excluded) const {
  std::optional<Change> first;
  const double h = t - time_;
  for (int i = 0; i < fleet.contacts(); ++i) {
    const ContactState& state = states_[i];
    const contact::Kinematics now = fleet.event_kinematics(i);
    const bool gain = !state.touching && !(state.kinematics.penetration > 0.0);
    std::optional<Change> found;
    if (state.touching != fleet.touches(i)) {
      found = Change{i, change_between(fleet, i, time_, state.kinematics, t, now), gain, false, gain};
    } else {
      const double sign = state.touching ? -1.0 : 1.0;
      const Cubic alpha = penetration(state.kinematics, now, h);
      const std::optional<double> s = alpha.extreme(sign);
      const bool possible = gain || fleet.contact(i).lifted;  // else the rate has jumped at a kink of the track
      if (s && possible && sign * alpha.at(*s) > 0.0) {
        found = Change{i, time_ + *s * h, gain, true, gain && fleet.contact(i).touched};
      } else if (gain && time_to_touch(i) < h) {  // a rebound within the step cannot be excluded
        found = Change{i, time_ + time_to_touch(i), gain, true, fleet.contact(i).touched};
      } else if (gain && fleet.contact(i).touched) {  // the wheel continued to rise, fell and rebounded
        found = Change{i, time_ + 0.5 * h, gain, true, true};
      }
    }
    if (found && !(gain && excluded(i)) && (!first || found->time < first->time)) first = found;
  }
  return first;
}

void Separations::accept(const Fleet& fleet, double t) {
  const bool first = states_.empty();
  states_.resize(static_cast<std::size_t>(fleet.contacts()));
  for (int i = 0; i < fleet.contacts(); ++i) {
    ContactState& state = states_[i];
    const Contact& c = fleet.contact(i);
    const contact::Kinematics now = fleet.event_kinematics(i);
    const bool touching = fleet.touches(i);
    state.just_closed = !first && touching && !state.touching;
    if (state.compressed_by >= 0) record_impact(fleet, i, t, state);
    if (!touching && (first || state.touching)) {
      state.open = static_cast<int>(list_.size());
      const double start = first ? t : change_between(fleet, i, time_, state.kinematics, t, now);
      list_.push_back({i, first, fleet.coordinates(c).x(), start});
    } else if (state.just_closed && state.open >= 0) {
      Separation& entry = list_[state.open];
      const double across = t - time_, remaining = time_to_touch(i);  // the onset of a damper disturbs the cubic
      const double closing_time =
          remaining < across ? time_ + remaining : change_between(fleet, i, time_, state.kinematics, t, now);
      entry.duration = closing_time - entry.start;
      entry.approach_speed = std::max(state.kinematics.penetration_rate, now.penetration_rate);
      entry.impact_force = c.force.normal;
      state.compressed_by = now.penetration_rate > 0.0 ? state.open : -1;
      state.open = -1;
    }
    state.touching = touching;
    state.kinematics = now;
  }
  time_ = t;
}

/// The compression ends when the rate changes its sign: there the force depends on the penetration only.
void Separations::record_impact(const Fleet& fleet, int contact, double t, ContactState& state) {
  const Contact& c = fleet.contact(contact);
  const contact::Kinematics& now = fleet.kinematics(contact);
  double& greatest = list_[state.compressed_by].impact_force;
  greatest = std::max(greatest, c.force.normal);
  if (now.penetration_rate > 0.0) return;
  state.compressed_by = -1;
  const Cubic alpha = penetration(state.kinematics, now, t - time_);
  if (const std::optional<double> s = alpha.extreme(1.0))
    greatest = std::max(greatest, contact::force(c.law, {alpha.at(*s), 0.0, 0.0}, c.approach_speed).normal);
}

}  // namespace traverse::train
