// The low-passed unloading of each wheel, relative to its initial force, the least and the greatest normal force of all
// wheels, and the largest unloading of a wheel, interpolated between steps (extremum_tracker.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "results/recorder.hpp"
#include "run/extremum_tracker.hpp"
#include "run/plan.hpp"
#include "train/fleet.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// "vehicle 3, rear_wheel", for wheels in the order of the fleet without further contact points.
std::string wheel_name(const train::Fleet& fleet, std::size_t wheel);

/// Whether wheel forces are low-passed: the scene starts in equilibrium and has wheels, and the user or a limit
/// requires it.
bool filters_wheels(const scene::Scene& scene);

/// Stores the force of every wheel at the plan's interval and filters all of them at the end of the run. Memory: 8
/// bytes for each instant and wheel, at most DeckAcceleration::max_stored numbers.
class FilteredWheels {
 public:
  /// frequency in Hz; level: unloading from which a wheel is considered unloaded.
  FilteredWheels(double frequency, double level, const Plan& plan, std::size_t wheels);

  /// Whether this is the next multiple of the plan's interval; then all wheels must be added, in their order.
  bool is_due(double t) const;
  void add(double force) { rows_.push_back(force); }

  /// After the last instant, once. The end of the series, in which the filter lacks the later forces (unsettled_end),
  /// is not evaluated.
  results::FilteredUnloading finish(const train::Fleet& fleet);
  void keep(base::Bytes& bytes) { bytes(rows_); }

 private:
  double frequency_, level_, interval_;
  std::size_t wheels_;
  std::vector<double> rows_;  // a row of wheels for each instant
};

/// The least and the greatest normal force of all wheels, and the largest unloading of a wheel, evaluated at every step
/// and interpolated between steps.
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

  /// The least and the greatest force, N, and the largest unloading relative to the force at the start; place: the
  /// wheel in the order of the fleet. Infinite, and an unloading below 0, before the first instant.
  struct Extremes {
    Extreme least{std::numeric_limits<double>::infinity()}, greatest{-std::numeric_limits<double>::infinity()};
    Extreme unloading{-1.0};
  };
  /// Those of the wheels [first, past).
  Extremes of(std::size_t first, std::size_t past) const;
  Extremes of_all() const { return of(0, extremes_.size()); }
  void keep(base::Bytes& bytes) { bytes(latest_, at_start_, extremes_); }

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
  std::vector<Extremes> extremes_;
  std::vector<double> kinks_;
};

}  // namespace traverse::run
