// Contact events in the accepted steps: openings, closings and impacts. They determine at which times steps have to
// end, and how long steps may be.
#pragma once

#include <mpi.h>

#include <limits>
#include <optional>
#include <vector>

#include "train/fleet.hpp"
#include "train/separations.hpp"
#include "train/vehicle_share.hpp"

namespace traverse::coupling {

class ContactEvents {
 public:
  /// impact_steps: the least number of steps in an impact; 0: no limit.
  ContactEvents(MPI_Comm comm, train::Fleet& fleet, const train::VehicleShare& share, int impact_steps)
      : comm_(comm), fleet_(fleet), share_(share), impact_steps_(impact_steps) {}

  /// Collective. Records the contacts at an accepted instant: openings and closings, approach speeds, and impacts that
  /// begin or are expected. Returns the elastic energy that is lost because damped contacts open while they are
  /// compressed, J.
  double accept(double t);
  /// Whether a guided wheel is within the tolerance (s) of the end of the beam that it is about to leave, at the last
  /// accepted instant.
  bool leaves_guide(double tolerance) const;

  /// The first opening or closing in the step that ends at t, which the fleet is set to. Closings that were expected
  /// within the tolerance (s) are excluded.
  std::optional<train::Change> change(double t, double tolerance) const;
  /// Time tolerance for locating an opening or closing of this contact, s.
  double tolerance_of(int contact, double tolerance) const;
  /// Longest step during an impact, s.
  double step_limit(double t) const;
  /// Longest step that overshoots the next impact by at most `tolerance`, s.
  double time_to_impact(double tolerance) const;
  const train::Separations& separations() const { return separations_; }
  void keep(base::Bytes& bytes) { bytes(separations_, impacts_, impact_durations_); }

 private:
  struct Impact {
    double end = 0.0;                                       // s; in the past: no impact
    double step = std::numeric_limits<double>::infinity();  // s, longest during the impact
  };
  double record_released();
  void record_impacts(double t);

  MPI_Comm comm_;
  train::Fleet& fleet_;
  const train::VehicleShare& share_;
  int impact_steps_;
  train::Separations separations_;
  std::vector<Impact> impacts_;  // one per contact
  std::vector<double> impact_durations_;
};

}  // namespace traverse::coupling
