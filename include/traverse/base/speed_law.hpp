// The speed of a train or load along the track over time, and its distance since t = 0.
#pragma once

#include <vector>

#include "traverse/base/time_function.hpp"

namespace traverse::base {

/// A speed (m/s) that is constant or piecewise linear in time and never changes its sign. It is positive to the right
/// and negative to the left.
class SpeedLaw {
 public:
  SpeedLaw() = default;
  explicit SpeedLaw(double speed) : distance_(0.0, speed) {}
  /// A piecewise linear speed through the rows t (s), v (m/s), with the end values outside. Throws InputError if the
  /// times do not increase, if speeds have both signs, or if all of them are 0.
  static SpeedLaw over_time(std::vector<double> times, std::vector<double> speeds);
  /// Rows x (m), v (m/s) for an object that is at `start` at t = 0. The acceleration is constant between two rows, so
  /// that v^2 is linear in x; the end speeds apply outside. An object whose speed is 0 in a row starts with the
  /// acceleration of the interval ahead of it. Throws InputError as above, if two neighbouring rows have the speed 0,
  /// and if the speed remains 0 at `start`.
  static SpeedLaw over_place(std::vector<double> places, std::vector<double> speeds, double start);
  /// Rows t (s), x (m): the speed is linear in time between each row and the middle to the next one, and passes all
  /// rows exactly, also those of a constant acceleration. Outside, the end speeds apply. Throws InputError if the times
  /// do not increase, if x moves to both sides, or if it does not move.
  static SpeedLaw through(const std::vector<double>& times, const std::vector<double>& places);

  /// Whether the speed is constant.
  bool constant() const { return distance_.straight(); }
  double speed(double t) const { return distance_.rate(t); }
  /// m/s2; at a jump the value on one of its sides.
  double acceleration(double t) const { return distance_.acceleration(t); }
  /// Distance since t = 0, m; negative to the left.
  double distance(double t) const { return distance_.value(t); }
  /// The position x + distance(t).
  TimeFunction from(double x) const;
  /// The first time at which `distance` is covered: negative if it is behind the start, infinite if it is never
  /// covered.
  double time_of(double distance) const;
  /// 1 to the right, -1 to the left, 0 if the speed is always 0.
  double direction() const;
  /// The time after which the speed remains 0; infinite if there is none.
  double standstill() const;
  /// The largest magnitude of the speed for t >= 0.
  double fastest() const;
  /// Times at which the acceleration jumps.
  std::vector<double> kinks() const { return distance_.kinks(); }

 private:
  TimeFunction distance_{0.0, 0.0};
};

}  // namespace traverse::base
