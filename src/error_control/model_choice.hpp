// What was chosen for a scene: a model, and what is promised of it.
#pragma once

#include <optional>

#include "base/bytes.hpp"
#include "error_control/error_estimate.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

struct Choice {
  NumericalModel model;
  Accuracy accuracy;
  std::optional<double> low_pass;  // Hz, up to which deck accelerations count, where the scene leaves that open

  void keep(base::Bytes& bytes);
};

/// The scene by a model. A mesh that is given for each span stays where the model has as many elements in the longest.
Scene with(Scene scene, const NumericalModel& model);
/// The same by what was chosen for it or for others like it, as far as it leaves mesh, step and modes open.
Scene completed(Scene scene, NumericalModel chosen);
/// What serves where either does.
NumericalModel finer(const NumericalModel& one, const NumericalModel& other);

/// Elements of the longest span, the others in proportion and even; with a layered track elements of the rail a bay.
void set_mesh(Scene& scene, int elements);
int mesh_of(const Scene& scene);
/// Whether nodes meet probes and the foundation's springs, inside of whose elements errors fall slowly.
bool aligned(const Scene& scene, int elements);
/// So many elements, or up to `most` times as many where these are aligned.
int aligned_mesh(const Scene& scene, int elements, double most = 1.5);

}  // namespace traverse::app
