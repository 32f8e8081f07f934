// How much of its force at the start each wheel loses, low-passed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "run/plan.hpp"
#include "train/fleet.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// "vehicle 3, rear_wheel", of the wheels in the order of the fleet without further points of contact.
std::string wheel_name(const train::Fleet& fleet, std::size_t wheel);

/// Whether forces are to be low-passed: the scene has wheels at rest at the start, and the user or a limit asks for it.
bool filters_wheels(const Scene& scene);

/// Keeps the force of every wheel at the plan's interval until the end of the run, when all are low-passed. Eight bytes
/// an instant and wheel, DeckAcceleration::most_kept numbers at most.
class FilteredWheels {
 public:
  /// frequency in Hz; level: the part of its force from which on a wheel counts as unloaded.
  FilteredWheels(double frequency, double level, const Plan& plan, std::size_t wheels);

  /// Whether this is the next multiple of the plan's interval; then all wheels are to be added, in their order.
  bool wants(double t) const;
  void add(double force) { kept_.push_back(force); }

  /// After the last instant, once.
  results::FilteredUnloading finish(const train::Fleet& fleet);
  void keep(base::Bytes& bytes) { bytes(kept_); }

 private:
  double frequency_, level_, interval_;
  std::size_t wheels_;
  std::vector<double> kept_;  // a row of wheels for each instant
};

}  // namespace traverse::app
