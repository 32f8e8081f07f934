// The least and the greatest normal force of all wheels, and the largest unloading of a wheel, evaluated at every step
// and interpolated between steps (interpolated_extremum.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/bytes.hpp"
#include "run/interpolated_extremum.hpp"

namespace traverse::run {

class WheelExtremes {
 public:
  WheelExtremes() = default;
  /// kinks: ascending stations at which the track or the bridge has a kink in slope, so that a wheel force over time
  /// has a kink too.
  WheelExtremes(std::size_t wheels, std::vector<double> kinks);

  /// Adds the next instant of a wheel whose centre is at x.
  void add(std::size_t wheel, double t, double x, double force);
  /// After the last instant.
  void finish();

  /// The least force, N; place: the wheel in the order of the fleet; infinite before the first instant.
  const Extreme& least() const { return least_; }
  const Extreme& greatest() const { return greatest_; }
  /// The largest unloading relative to the force at the start; below 0 before the first instant.
  const Extreme& unloading() const { return unloading_; }
  void keep(base::Bytes& bytes) { bytes(latest_, at_start_, least_, greatest_, unloading_); }

 private:
  /// The latest instants of a wheel.
  struct Latest {
    Samples force;
    std::array<double, Samples::max_count> x{};
  };
  void record(double force, double time, std::size_t wheel);
  /// Records the instant i if it is extreme.
  void evaluate(const Latest& latest, std::size_t i, std::size_t wheel);
  /// Whether the wheel is in contact and passes no kink from instant i to j.
  bool smooth(const Latest& latest, std::size_t i, std::size_t j) const;

  std::vector<Latest> latest_;
  std::vector<double> at_start_;  // N, of every wheel
  std::vector<double> kinks_;
  Extreme least_{std::numeric_limits<double>::infinity()}, greatest_{-std::numeric_limits<double>::infinity()};
  Extreme unloading_{-1.0};
};

}  // namespace traverse::run
