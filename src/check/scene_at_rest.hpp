// The first run of a scene at rest before its first step: static wheel loads and positions, and the first frequency.
#pragma once

#include <memory>
#include <string>

#include "coupling/system.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::check {

/// The first scene of a study, with all its speeds as a sweep; another scene as it is. Throws InputError.
scene::Scene first_scene(const scene::Scene& given);
/// The first run of such a scene.
scene::Scene first_run(const scene::Scene& whole);

struct SceneAtRest {
  /// Not collective. Uses the first mesh of trial runs, which is fine enough for statics and the first frequency, and
  /// reads no option of PETSc. Throws the errors of the run before its first step.
  explicit SceneAtRest(const scene::Scene& given);
  SceneAtRest(const SceneAtRest&) = delete;
  SceneAtRest& operator=(const SceneAtRest&) = delete;

  scene::Scene whole;                        // first_scene
  scene::Scene scene;                        // its first run
  std::unique_ptr<run::SharedBeam> shared;   // of `scene`
  std::unique_ptr<coupling::System> system;  // at rest, with its static loads; null for an analysis of modes

  /// The body that is farthest from its position in the input, unless all of them are where they were put.
  struct Displaced {
    double distance = 0.0;  // m
    double up = 0.0;        // m, its vertical part
    std::string vehicle, body;
  };
  Displaced displaced;

  /// Static wheel loads, then moving forces.
  const std::vector<coupling::StaticLoad>& weights() const { return system->weights().all(); }
  /// Hz, of the first bending mode, linearised; 0 if the bridge can move freely.
  double first_frequency() const;

 private:
  void put_to_rest();
};

}  // namespace traverse::check
