// Runs of the first part of a scene with several meshes and steps, to measure discretisation errors.
#pragma once

#include <mpi.h>

#include <deque>
#include <limits>
#include <string>
#include <utility>

#include "error_control/linearisation_error.hpp"
#include "error_control/model_choice.hpp"
#include "run/response_extremes.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// Output interval of trial runs in steps, for the energies; peaks are evaluated at every step.
inline constexpr double trial_steps_per_sample = 32.0;

/// The scene with a shorter approach: a train on a level layered track starts some bays before the bridge, and the
/// track is shortened by the same distance. The removed motion contains no new event.
scene::Scene trim_approach(const scene::Scene& scene);

/// The part of the scene that moves until `end`, s: without vehicles that enter the beam later and without spans that
/// no motion reaches.
scene::Scene restrict_to_window(const scene::Scene& scene, double end);

/// The result of a run of which only the peaks are needed.
struct RunPeaks {
  run::ResponseExtremes peaks;
  double steps = 0.0;    // cost of the run in steps, including solves and factorisations
  bool complete = true;  // false: ended at the limit of its cost or of the linearisation residual
  bool lost_contact = false;
  double residual = 0.0;        // residual of linear vehicles, coupling::System::linearisation_residual
  double energy_missing = 0.0;  // relative to the change of the energies
};

/// Collective. A run of the scene, whose step is given, sampled at every step. Its accelerations are low-passed if the
/// scene defines the frequency. The run ends if its cost, in steps, exceeds max_cost; solves and factorisations are
/// converted to steps.
RunPeaks peaks_of(MPI_Comm comm, const scene::Scene& scene, double max_cost = std::numeric_limits<double>::infinity());

/// Trial runs would exceed their cost limit. The cost is computed from counts, so that the same scene ends in the same
/// way on every machine.
struct CostLimitExceeded {};

/// The linearisation residual of a trial run exceeds its limit.
struct ResidualTooLarge {
  double residual = 0.0;  // coupling::System::linearisation_residual
};

class TrialRuns {
 public:
  TrialRuns(MPI_Comm comm, scene::Scene scene)
      : comm_(comm), scene_(std::move(scene)), residual_limit_(error_control::default_residual_limit(scene_)) {}

  /// Collective. The peaks of a run, by the scene's integrator or another one; they are stored. CostLimitExceeded if
  /// the cost would exceed the limit of all runs. If the scene leaves the vehicle model open, it is linear; then
  /// ResidualTooLarge if the linearisation residual is too large.
  const run::ResponseExtremes& run(int elements, double step, const std::string& integrator = {});
  /// Collective. The missing energy after the run, relative to the change of the energies.
  double energy_missing(int elements, double step);
  std::size_t count() const { return stored_.size(); }
  /// The limit of the linearisation residual.
  double residual_limit() const { return residual_limit_; }
  bool lost_contact() const { return lost_contact_; }  // wheels lost contact in one of them
  /// The estimated cost of a run, and of all runs so far, s. It is computed from counts, because decisions must not
  /// depend on the clock.
  double seconds(int elements, double step, const std::string& integrator = {}) const;
  double seconds() const;

 private:
  bool needs_measurement(double residual) const;
  void measure_linearisation(int elements, double step);
  struct StoredRun {
    scene::NumericalModel model;
    run::ResponseExtremes peaks;
    double energy_missing = 0.0;
  };
  const StoredRun& stored_run(int elements, double step, const std::string& integrator);

  MPI_Comm comm_;
  scene::Scene scene_;
  std::deque<StoredRun> stored_;  // a deque, because references to entries must remain valid
  double residual_limit_;
  bool measured_linearisation_ = false;  // the limit was measured by comparison with the mechanisms
  bool lost_contact_ = false;
  double spent_ = 0.0;  // s, estimated from the computed steps
};

}  // namespace traverse::error_control
