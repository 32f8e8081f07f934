// The low-passed unloading of each wheel, relative to its initial force.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results/recorder.hpp"
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

  /// After the last instant, once.
  results::FilteredUnloading finish(const train::Fleet& fleet);
  void keep(base::Bytes& bytes) { bytes(rows_); }

 private:
  double frequency_, level_, interval_;
  std::size_t wheels_;
  std::vector<double> rows_;  // a row of wheels for each instant
};

}  // namespace traverse::run
