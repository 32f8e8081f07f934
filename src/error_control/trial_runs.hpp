// Runs of the beginning of a scene with several meshes and steps, to see what these change.
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

namespace traverse::app {

/// The scene with a train that comes over a level layered track some bays before the bridge, where it starts farther
/// off, and with so much less of the track: what it does until then tells nothing new.
Scene trim_approach(const Scene& scene);

/// The part of the scene that moves until then: vehicles that come onto the beam later and spans that nothing reaches
/// are left out.
Scene restrict_to_window(const Scene& scene, double end);

/// What is left of a run of which only the peaks are wanted.
struct RunPeaks {
  ResponseExtremes peaks;
  double steps = 0.0;    // taken, those that were taken again for a contact's change too
  bool complete = true;  // false: ended at the limit of its steps
  bool lost_contact = false;
  double defect = 0.0;          // of linear vehicles, coupling::System::defect
  double energy_missing = 0.0;  // of what the energies change by
};

/// Collective. A run of the scene, whose step is given, sampled at every step. Its accelerations are low-passed where
/// the scene names the frequency.
RunPeaks peaks_of(MPI_Comm comm, const Scene& scene, double most_steps = std::numeric_limits<double>::infinity());

/// Trial runs would take more steps than they may: by counting, so that the same scene ends so everywhere.
struct TooMuchWork {};

/// Linear vehicles that were taken for a trial leave out more than they may.
struct NotLinear {
  double defect = 0.0;  // coupling::System::defect
};

class TrialRuns {
 public:
  TrialRuns(MPI_Comm comm, Scene scene)
      : comm_(comm), scene_(std::move(scene)), most_defect_(app::most_residual(scene_)) {}

  /// Collective. The peaks of a run, by the scene's integrator or another; kept. TooMuchWork where it would exceed what
  /// all runs may take. Vehicles that the scene leaves open are taken as linear: NotLinear where that leaves out too
  /// much.
  const ResponseExtremes& run(int elements, double step, const std::string& integrator = {});
  /// Collective. What energy is missing after the run, of what the energies change by.
  double energy_missing(int elements, double step);
  std::size_t count() const { return kept_.size(); }
  /// What linear vehicles may be out of balance by.
  double most_residual() const { return most_defect_; }
  bool lost_contact() const { return lost_contact_; }  // wheels did in one of them
  /// An estimate of what a run takes, or of what all took so far, s: by counting, since decisions must not depend on
  /// the clock.
  double seconds(int elements, double step, const std::string& integrator = {}) const;
  double seconds() const;

 private:
  bool linear_is_in_doubt(double defect) const;
  void measure_linear(int elements, double step);
  struct Kept {
    NumericalModel model;
    ResponseExtremes peaks;
    double energy_missing = 0.0;
  };
  const Kept& kept_run(int elements, double step, const std::string& integrator);

  MPI_Comm comm_;
  Scene scene_;
  std::deque<Kept> kept_;  // references to its entries stay
  double most_defect_;
  bool measured_linear_ = false;  // against the mechanisms
  bool lost_contact_ = false;
  double spent_ = 0.0;  // s, estimated from the steps that were taken
};

}  // namespace traverse::app
