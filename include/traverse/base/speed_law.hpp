// How something runs along the track: its speed over time, and the way that it has gone since t = 0.
#pragma once

#include <vector>

#include "traverse/base/time_function.hpp"

namespace traverse::base {

/// A speed (m/s) that is constant or piecewise linear in time, all of one sign: above 0 to the right, below 0 to the
/// left.
class SpeedLaw {
 public:
  SpeedLaw() = default;
  explicit SpeedLaw(double speed) : way_(0.0, speed) {}
  /// Straight lines between the rows t (s), v (m/s), the end values outside. InputError where times do not rise, speeds
  /// are of both signs or all 0.
  static SpeedLaw over_time(std::vector<double> times, std::vector<double> speeds);
  /// Rows x (m), v (m/s) for something that is at `start` at t = 0: the acceleration is constant between two rows, so
  /// that v^2 is linear in x, and the end speeds hold outside. Something at rest in a row begins to move with the
  /// acceleration of the interval before it. InputError as above, where two rows next to each other have the speed 0,
  /// and where `start` lies where the speed is 0 for good.
  static SpeedLaw over_place(std::vector<double> places, std::vector<double> speeds, double start);

  /// Whether the speed is the same at all times.
  bool constant() const { return way_.straight(); }
  double speed(double t) const { return way_.rate(t); }
  /// m/s2; at a jump that of one of its sides.
  double acceleration(double t) const { return way_.acceleration(t); }
  /// The way gone since t = 0, m; below 0 to the left.
  double distance(double t) const { return way_.value(t); }
  /// x + distance(t).
  TimeFunction from(double x) const;
  /// When `distance` is gone, for the first time: before 0 where it lies behind, infinite where it is never gone.
  double time_of(double distance) const;
  /// 1 to the right, -1 to the left, 0 where it stands at all times.
  double direction() const;
  /// From when on it stands; infinite where it never does.
  double standstill() const;
  /// The greatest magnitude of the speed from t = 0 on.
  double fastest() const;
  /// Times at which the acceleration jumps.
  std::vector<double> kinks() const { return way_.kinks(); }

 private:
  TimeFunction way_{0.0, 0.0};
};

}  // namespace traverse::base
