// Contact events in the accepted steps: openings, closings and impacts. They determine at which times steps have to
// end, and how long steps may be.
#pragma once

#include <mpi.h>

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "structure/structure.hpp"
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

/// Times at which wheels turn about a kink of the running surface, at the end of the bridge or of a span.
///
/// With the slopes s_l and s_r of the surface on the two sides of a kink at x_c, a wheel of radius r touches the left
/// side until its centre is at x_c - r s_l and the right side from x_c - r s_r on (with the sines of the angles in
/// place of the slopes). Between these positions, for a few microseconds at speed, it turns about a crest; in a valley
/// the contact changes sides at their middle. The forces are continuous there, but the penetration rate and the power
/// of the drive jump: a step has to end at both positions.
class KinkEvents {
 public:
  /// structure: null without a structure; then there are no kinks.
  KinkEvents(MPI_Comm comm, structure::Structure* structure, const train::Fleet& fleet,
             const train::VehicleShare& share)
      : comm_(comm), structure_(structure), fleet_(fleet), share_(share) {}

  /// Lists the kinks that the fleet's wheels, moving by `laws`, pass until `end`. Called before the first step; step:
  /// the longest step, s.
  void list_kinks(const std::vector<base::SpeedLaw>& laws, double end, double step);

  std::size_t passages() const { return kinks_.size(); }

  /// The time at which a wheel begins (end = 0) or ends (end = 1) to turn about a kink, and the tolerance for the end
  /// of a step there.
  struct KinkEvent {
    double time = 0.0, tolerance = 0.0;  // s
    std::size_t kink = 0;
    int end = 0;
  };
  /// Collective. The first such time within h s after t, predicted from the accepted state v, w at t.
  std::optional<KinkEvent> next(double t, double h, const double* v, const double* w);
  /// Collective. The same time computed from the state at the end of a step, to which the vehicles are set.
  double time_of(const KinkEvent& event, double t, const double* v, const double* w);

 private:
  /// The passage of a wheel's centre over a kink of the surface.
  struct Kink {
    double time = 0.0;   // s
    int wheel = 0;       // index in Fleet::wheels
    double x = 0.0;      // m
    double speed = 0.0;  // m/s
  };
  double longest_turn(const Kink& kink) const;
  std::array<double, 2> turning_times(const Kink& kink, double t, const double* v, const double* w);

  MPI_Comm comm_;
  structure::Structure* structure_;
  const train::Fleet& fleet_;
  const train::VehicleShare& share_;
  std::vector<Kink> kinks_;  // ascending in time
  double longest_step_ = 0.0;
  std::size_t next_ = 0;       // the first kink that may not have been passed
  std::vector<int> elements_;  // the elements on both sides of a kink
  std::vector<double> v_, w_;  // displacements and rates of these elements
};

}  // namespace traverse::coupling
