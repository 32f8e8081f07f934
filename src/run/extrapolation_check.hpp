// Checks a run after the end of the trial runs that chose its step: springs, supports and sleepers that open or close
// for the first time, and curves that are rougher within a step than before; and whether the theory of small
// displacements is valid for the bridge's deflection.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "run/response_extremes.hpp"
#include "structure/nonlinear_foundation.hpp"
#include "train/fleet.hpp"
#include "traverse/beam/model.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

class ExtrapolationCheck {
 public:
  /// Ratio of roughness up to which the difference between trial runs and run is normal.
  static constexpr double smooth = 2.0;

  ExtrapolationCheck() = default;  // trial runs covered the whole run
  /// until: end of the trial runs, s of the run. beam: null without a bridge.
  ExtrapolationCheck(double until, const train::Fleet& fleet, const beam::BeamModel* beam);

  /// Whether instants need the internal forces of vehicles.
  bool needs_springs() const { return !springs_.empty(); }
  /// Evaluates the next instant, before `peaks` does.
  void add(double t, const train::Fleet& fleet, const structure::NonlinearForces& foundation, ResponseExtremes& peaks);

  /// The first part that opened or closed as never before, with the time, in words; "" if there was none.
  const std::string& new_event() const { return new_event_; }
  /// The ratio of the curves' roughness to that before, SecondDifference::times; 0 if the run has no later part.
  double roughness(const ResponseExtremes& peaks) const {
    return roughness_before_ ? peaks.roughness().ratio_to(*roughness_before_) : 0.0;
  }

  void keep(base::Bytes& bytes) { bytes(states_, roughness_before_, new_event_); }

 private:
  /// A part that may separate. Parts of a kind, such as the springs of all vehicles of a type, count as one.
  struct Part {
    std::size_t kind = 0;
    std::string name;
  };
  struct Spring {
    int vehicle = 0, spring = 0;  // index of the vehicle in the fleet, and of the spring in its mechanism
    bool torsion = false;
    Part part;
  };
  struct Support {
    std::size_t row = 0, place = 0;  // index in foundation_kinds, and of the point or span
    Part part;
  };
  void add_springs(const train::Fleet& fleet);
  void add_supports(const beam::BeamModel& beam);
  void record(double t, const Part& part, double force);

  double until_ = std::numeric_limits<double>::infinity();
  std::vector<Spring> springs_;
  std::vector<Support> supports_;
  Part sleepers_;                      // sleepers over a gap
  std::vector<unsigned char> states_;  // for each kind, one bit each: unloaded, compressed, tensioned
  std::optional<SecondDifference> roughness_before_;
  std::string new_event_;
};

/// Prints a warning on the first rank if the deflection (m) is a large part of the longest span. SolverError if it is
/// impossibly large: then some quantity is not in SI units. The same on every rank.
void check_deflection(MPI_Comm comm, const scene::Scene& scene, double deflection);

}  // namespace traverse::run
