// The numerical model chosen for a scene, with its error estimates.
#pragma once

#include <optional>

#include "base/bytes.hpp"
#include "error_control/error_estimate.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

struct Choice {
  scene::NumericalModel model;
  Accuracy accuracy;
  std::optional<double> low_pass;  // Hz, cut-off frequency of deck accelerations, if the scene leaves it open
  std::string open_search;         // state of the search if the run is its last one; empty: it is complete

  void keep(base::Bytes& bytes);
};

/// The scene with this model. A mesh that is given for each span remains if the model has the same number of elements
/// in the longest one.
scene::Scene with(scene::Scene scene, const scene::NumericalModel& model);
/// Like `with`, but sets only mesh, step and modes that the scene does not prescribe.
scene::Scene completed(scene::Scene scene, scene::NumericalModel chosen);
/// A model that is at least as accurate as each of the two models.
scene::NumericalModel finer(const scene::NumericalModel& one, const scene::NumericalModel& other);

/// Sets the number of elements in the longest span; other spans get proportional, even numbers. With a layered track:
/// the number of rail elements in one bay.
void set_mesh(scene::Scene& scene, int elements);
int mesh_of(const scene::Scene& scene);
/// Whether all probes and point springs are at nodes. Inside an element errors decrease more slowly.
bool aligned(const scene::Scene& scene, int elements);
/// The first aligned mesh with `elements` to most * elements elements; `elements` if none is aligned.
int aligned_mesh(const scene::Scene& scene, int elements, double most = 1.5);

}  // namespace traverse::error_control
