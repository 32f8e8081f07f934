// A scene set up as its run would be, up to the first step.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "run/passage.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

struct Look {
  /// On this rank alone. Throws what the run itself would throw before its first step.
  explicit Look(const Scene& given);
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;

  Scene whole;                      // as given; of a study its first scene, with all speeds in its sweep
  Scene scene;                      // one run of it: the first one
  std::vector<std::string> notes;   // model
  std::vector<std::string> choice;  // of mesh and step
  bool tried = false;               // trial runs choose these, from the mesh in `scene` and this step on
  double first_step = 0.0, longest_step = 0.0, horizon = 0.0;  // s; of a trial run
  std::unique_ptr<SharedBeam> shared;
  std::unique_ptr<Passage> passage;  // at its start; null: the scene asks for no motion and no rest
  std::vector<double> frequencies;   // Hz, the first distinct ones of the bridge
  std::size_t runs = 1;              // of a sweep or a study

  const beam::Beam* bridge() const { return shared->bridge(); }
  /// Of wheels at rest, then of moving forces.
  const std::vector<coupling::StaticLoad>& weights() const { return passage->system().weights().all(); }
  /// s; 0 where there is no motion.
  double end_time() const { return passage ? passage->plan().end_time : 0.0; }

 private:
  void choose_mesh_and_step();
  void find_frequencies();
};

}  // namespace traverse::app
