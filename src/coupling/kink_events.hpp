// Where wheels turn about a corner of the running surface, at the end of the bridge or of a span.
//
// With the slopes s_l and s_r of the surface on either side of a corner at x_c, a wheel of radius r touches the left
// side until its centre is at x_c - r s_l and the right side from x_c - r s_r on (their sines for the slopes). In
// between, a few microseconds at speed, it turns about a crest; in a valley it changes sides half-way. Forces keep
// their values there, but the rate of penetration and the power of the drive change at once: a step has to end at
// either end of that.
#pragma once

#include <mpi.h>

#include <array>
#include <optional>
#include <vector>

#include "structure/structure.hpp"
#include "train/fleet.hpp"
#include "train/vehicle_share.hpp"

namespace traverse::coupling {

class KinkEvents {
 public:
  /// structure: null where there is none, and then no corners.
  KinkEvents(MPI_Comm comm, structure::Structure* structure, const train::Fleet& fleet,
             const train::VehicleShare& share)
      : comm_(comm), structure_(structure), fleet_(fleet), share_(share) {}

  /// Before the first step, the longest one: corners that the fleet's wheels, which run so, come to until `end`.
  void expect(const std::vector<base::SpeedLaw>& laws, double end, double step);

  /// A wheel begins or ends to turn about a corner: when, and how exactly a step has to end there.
  struct KinkPassage {
    double time = 0.0, tolerance = 0.0;  // s
    std::size_t corner = 0;
    int end = 0;
  };
  /// Collective. The first such time within h s from the accepted state v, w at t, as it lets it be expected.
  std::optional<KinkPassage> next(double t, double h, const double* v, const double* w);
  /// Collective. The same as it is found at the end of a step, where the vehicles are.
  double time_of(const KinkPassage& turn, double t, const double* v, const double* w);

 private:
  /// A wheel's centre passes a corner of the surface.
  struct Corner {
    double time = 0.0;   // s
    int wheel = 0;       // of the fleet's
    double x = 0.0;      // m
    double speed = 0.0;  // m/s
  };
  double longest_turn(const Corner& corner) const;
  std::array<double, 2> turning_times(const Corner& corner, double t, const double* v, const double* w);

  MPI_Comm comm_;
  structure::Structure* structure_;
  const train::Fleet& fleet_;
  const train::VehicleShare& share_;
  std::vector<Corner> corners_;  // ascending in time
  double longest_step_ = 0.0;
  std::size_t next_ = 0;       // the first that may not have been turned
  std::vector<int> elements_;  // on either side of a corner
  std::vector<double> v_, w_;  // of these
};

}  // namespace traverse::coupling
