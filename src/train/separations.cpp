// Cubic Hermite interpolation of the penetration between two accepted states, whose roots are the times at which a
// contact opens or closes and whose maximum yields the force of an impact.
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

  /// A root in [low, high], at whose ends the cubic has different signs.
  double root(double low, double high) const {
    const bool rises = at(high) > 0.0;
    for (int i = 0; i < 60; ++i) {
      const double s = 0.5 * (low + high);
      ((at(s) > 0.0) == rises ? high : low) = s;
    }
    return high;
  }
  /// Where it is extreme in (0, 1), farthest in the direction of `sign`.
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
  const bool by_force = low.penetration > 0.0 && high.penetration > 0.0;  // a damper lets go in spite of it
  if (by_force) {
    const double from = contact::normal_tendency(c.law, low, c.approach_speed);
    const double to = contact::normal_tendency(c.law, high, c.approach_speed);
    return from == to ? t_high : t_low + h * std::clamp(from / (from - to), 0.0, 1.0);
  }
  return t_low + h * penetration(low, high, h).root(0.0, 1.0);
}

double Separations::time_to_touch(int contact) const {
  const Seen& seen = seen_[contact];
  const auto& [penetration, rate, sliding] = seen.kinematics;
  return seen.touching || !(rate > 0.0) ? std::numeric_limits<double>::infinity() : std::max(-penetration, 0.0) / rate;
}

std::optional<Change> Separations::change(const Fleet& fleet, double t,
                                          const std::function<bool(int)>& left_out) const {
  std::optional<Change> first;
  const double h = t - time_;
  for (int i = 0; i < fleet.contacts(); ++i) {
    const Seen& seen = seen_[i];
    const contact::Kinematics& now = fleet.kinematics(i);
    const bool gain = !seen.touching && !(seen.kinematics.penetration > 0.0);
    std::optional<Change> found;
    if (seen.touching != fleet.touches(i)) {
      found = Change{i, change_between(fleet, i, time_, seen.kinematics, t, now), gain, false, gain};
    } else {
      const double sign = seen.touching ? -1.0 : 1.0;
      const Cubic alpha = penetration(seen.kinematics, now, h);
      const std::optional<double> s = alpha.extreme(sign);
      if (s && sign * alpha.at(*s) > 0.0) {
        found = Change{i, time_ + *s * h, gain, true, gain && fleet.contact(i).touched};
      } else if (gain && time_to_touch(i) < h) {  // a rebound within the step may have been anything
        found = Change{i, time_ + time_to_touch(i), gain, true, fleet.contact(i).touched};
      } else if (gain && fleet.contact(i).touched) {  // it went on rising, came down and rebounded
        found = Change{i, time_ + 0.5 * h, gain, true, true};
      }
    }
    if (found && !(gain && left_out(i)) && (!first || found->time < first->time)) first = found;
  }
  return first;
}

void Separations::accept(const Fleet& fleet, double t) {
  const bool first = seen_.empty();
  seen_.resize(static_cast<std::size_t>(fleet.contacts()));
  for (int i = 0; i < fleet.contacts(); ++i) {
    Seen& seen = seen_[i];
    const Contact& c = fleet.contact(i);
    const contact::Kinematics& now = fleet.kinematics(i);
    const bool touching = fleet.touches(i);
    seen.met = !first && touching && !seen.touching;
    if (seen.compressed_by >= 0) record_impact(fleet, i, t, seen);
    if (!touching && (first || seen.touching)) {
      seen.open = static_cast<int>(list_.size());
      const double start = first ? t : change_between(fleet, i, time_, seen.kinematics, t, now);
      list_.push_back({i, first, fleet.coordinates(c).x(), start});
    } else if (seen.met && seen.open >= 0) {
      Separation& entry = list_[seen.open];
      const double across = t - time_, left = time_to_touch(i);  // a damper that comes on bends the cubic
      const double met_at = left < across ? time_ + left : change_between(fleet, i, time_, seen.kinematics, t, now);
      entry.duration = met_at - entry.start;
      entry.approach_speed = std::max(seen.kinematics.penetration_rate, now.penetration_rate);
      entry.impact_force = c.force.normal;
      seen.compressed_by = now.penetration_rate > 0.0 ? seen.open : -1;
      seen.open = -1;
    }
    seen.touching = touching;
    seen.kinematics = now;
  }
  time_ = t;
}

/// The compression ends where the rate changes its sign: there the force is that of the penetration alone.
void Separations::record_impact(const Fleet& fleet, int contact, double t, Seen& seen) {
  const Contact& c = fleet.contact(contact);
  const contact::Kinematics& now = fleet.kinematics(contact);
  double& greatest = list_[seen.compressed_by].impact_force;
  greatest = std::max(greatest, c.force.normal);
  if (now.penetration_rate > 0.0) return;
  seen.compressed_by = -1;
  const Cubic alpha = penetration(seen.kinematics, now, t - time_);
  if (const std::optional<double> s = alpha.extreme(1.0))
    greatest = std::max(greatest, contact::force(c.law, {alpha.at(*s), 0.0, 0.0}, c.approach_speed).normal);
}

}  // namespace traverse::train
