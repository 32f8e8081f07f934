// What happens at contacts in the steps that are accepted: they part and meet, they strike. From it follow where steps
// have to end, and how long they may be.
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
  /// impact_steps: of an impact, at least; 0: as the step is.
  ContactEvents(MPI_Comm comm, train::Fleet& fleet, const train::VehicleShare& share, int impact_steps)
      : comm_(comm), fleet_(fleet), share_(share), impact_steps_(impact_steps) {}

  /// Collective. Notes the contacts as they are at an accepted instant: those lost and gained, the speeds with which
  /// they approach, the impacts that begin or are to come. Returns the energy that goes where a damper lets go of a
  /// surface not yet back, J.
  double accept(double t);

  /// With the fleet at t, the end of a step: the first contact lost or gained in it, but for gains that were to come
  /// within the tolerance (s).
  std::optional<train::Change> change(double t, double tolerance) const;
  /// Time tolerance for locating this contact's gain or loss, s.
  double tolerance_of(int contact, double tolerance) const;
  /// Longest step while an impact goes on, s.
  double step_limit(double t) const;
  /// Longest step that overshoots the next impact by at most `tolerance`, s.
  double time_to_impact(double tolerance) const;
  const train::Separations& separations() const { return separations_; }
  void keep(base::Bytes& bytes) { bytes(separations_, impacts_, impact_durations_); }

 private:
  struct Impact {
    double end = 0.0;                                       // s; past: none
    double step = std::numeric_limits<double>::infinity();  // s, the longest while it goes on
  };
  double record_released();
  void record_impacts(double t);

  MPI_Comm comm_;
  train::Fleet& fleet_;
  const train::VehicleShare& share_;
  int impact_steps_;
  train::Separations separations_;
  std::vector<Impact> impacts_;  // of every contact
  std::vector<double> impact_durations_;
};

}  // namespace traverse::coupling
