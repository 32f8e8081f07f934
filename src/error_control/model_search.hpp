// Searches mesh and step of a scene with a bridge by runs of the whole scene (companion_search.hpp).
#pragma once

#include <mpi.h>

#include <array>
#include <string>

#include "error_control/companion_search.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/model_choice.hpp"
#include "error_control/trial_runs.hpp"
#include "run/shared_beam.hpp"

namespace traverse::error_control {

class ModelSearch {
 public:
  /// The scene must have its first mesh, and its Rayleigh damping as a and b. end: of the run, s. Throws InputError if
  /// the first trial run would be too expensive, and ResidualTooLarge as `run`.
  ModelSearch(MPI_Comm comm, const scene::Scene& scene, const run::SharedBeam& shared, double end);

  /// Continues an open search for the same scene from the state that `state` returned. Throws FileError if it is
  /// damaged.
  ModelSearch(MPI_Comm comm, const scene::Scene& scene, const std::string& state);
  /// The state of an open search.
  std::string state();

  /// Collective. Throws ResidualTooLarge if linear vehicles are not accurate enough. leaves_last: as for
  /// CompanionSearch.
  void run(bool leaves_last) { search_.run(leaves_last); }
  /// Whether the errors of the choice are known only after its run, see `add_last`.
  bool open() const { return search_.open(); }
  /// Mesh, step and vehicles of the scene, with the error estimates as far as they are known.
  Choice choice();
  /// Adds the run of the choice, which was computed elsewhere. model: as it was computed.
  void add_last(const scene::NumericalModel& model, RunPeaks run);
  std::size_t trials() const { return trials_.count(); }

 private:
  SearchTask task();
  void keep(base::Bytes& bytes);

  scene::Scene scene_;
  FirstSteps steps_;
  TrialRuns trials_;
  std::array<std::string, run::quantities> why_not_;  // reasons whatever mesh and step are; empty: none
  CompanionSearch search_;
};

const char* unit_of_mesh(const scene::Scene& scene);

}  // namespace traverse::error_control
