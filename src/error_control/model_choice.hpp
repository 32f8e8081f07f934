// The numerical model chosen for a scene, with its error estimates.
#pragma once

#include <optional>

#include "base/bytes.hpp"
#include "error_control/error_estimate.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

struct Choice {
  NumericalModel model;
  Accuracy accuracy;
  std::optional<double> low_pass;  // Hz, cut-off frequency of deck accelerations, if the scene leaves it open

  void keep(base::Bytes& bytes);
};

/// The scene with this model. A mesh that is given for each span remains if the model has the same number of elements
/// in the longest one.
Scene with(Scene scene, const NumericalModel& model);
/// Like `with`, but sets only mesh, step and modes that the scene does not prescribe.
Scene completed(Scene scene, NumericalModel chosen);
/// A model that is at least as accurate as each of the two models.
NumericalModel finer(const NumericalModel& one, const NumericalModel& other);

/// Sets the number of elements in the longest span; other spans get proportional, even numbers. With a layered track:
/// the number of rail elements in one bay.
void set_mesh(Scene& scene, int elements);
int mesh_of(const Scene& scene);
/// Whether all probes and point springs are at nodes. Inside an element errors decrease more slowly.
bool aligned(const Scene& scene, int elements);
/// The first aligned mesh with `elements` to most * elements elements; `elements` if none is aligned.
int aligned_mesh(const Scene& scene, int elements, double most = 1.5);

}  // namespace traverse::app
