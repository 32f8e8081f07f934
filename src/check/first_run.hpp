// The first run of a scene, set up to its first step.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "run/simulation.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::check {

struct FirstRun {
  /// Not collective. Throws the errors of the run before its first step.
  explicit FirstRun(const scene::Scene& given);
  FirstRun(const FirstRun&) = delete;
  FirstRun& operator=(const FirstRun&) = delete;

  scene::Scene whole;               // the scene of the user; for a study its first scene, with all speeds in its sweep
  scene::Scene scene;               // its first run
  std::vector<std::string> notes;   // notes on the model
  std::vector<std::string> choice;  // choice of mesh and step
  bool has_trial_runs = false;      // trial runs choose mesh and step, starting from mesh and step of `scene`
  double first_step = 0.0, longest_step = 0.0;  // s
  std::unique_ptr<run::SharedBeam> shared;
  std::unique_ptr<run::Simulation> simulation;  // at its start; null for an analysis of modes
  std::vector<double> frequencies;              // Hz, the first distinct ones of the bridge
  std::size_t runs = 1;                         // number of runs of a sweep or a study

  const beam::Beam* bridge() const { return shared->bridge(); }
  /// s; 0 without motion.
  double end_time() const { return simulation ? simulation->plan().end_time : 0.0; }

 private:
  void choose_mesh_and_step();
  void find_frequencies();
};

}  // namespace traverse::check
