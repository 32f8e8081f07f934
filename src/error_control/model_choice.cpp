// Applies a model to a scene, combines two models, and sets meshes by one number of elements.
#include "error_control/model_choice.hpp"

#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"
#include "base/one_step_methods.hpp"

namespace traverse::error_control {

using scene::Scene;

namespace {

constexpr double same_node = 1e-9;
constexpr std::size_t max_stations = 10000;
constexpr int min_elements = 4;

bool is_node(const beam::BeamModel& beam, double x) {
  double start = 0.0;
  for (std::size_t i = 0; i < beam.spans.size(); start += beam.spans[i++]) {
    const double node = (x - start) / beam.spans[i] * beam.elements[i];
    if (x <= start + beam.spans[i] * (1.0 + same_node))
      return std::abs(node - std::round(node)) < same_node * beam.elements[i];
  }
  return false;
}

}  // namespace

void Choice::keep(base::Bytes& bytes) {
  bytes(model.modes, model.elements, model.step, model.method, model.vehicles, model.residual_limit,
        model.trials_lost_contact, model.window_tolerance, model.local_compliance, model.step_kinks, model.step_probes,
        accuracy, low_pass, open_search);
}

Scene with(Scene scene, const scene::NumericalModel& model) {
  scene.model = model;
  if (scene.beam && model.elements > 0 && (scene.mesh_open || model.elements != mesh_of(scene)))
    set_mesh(scene, model.elements);
  return scene;
}

Scene completed(Scene scene, scene::NumericalModel chosen) {
  if (!scene.mesh_open) chosen.elements = 0;
  if (scene.model.step) chosen.step = scene.model.step;
  if (!scene.modes_open) chosen.modes = scene.model.modes;
  return with(std::move(scene), chosen);
}

scene::NumericalModel finer(const scene::NumericalModel& one, const scene::NumericalModel& other) {
  scene::NumericalModel model = one;
  model.modes = one.modes > 0 && other.modes > 0 ? std::max(one.modes, other.modes)
                                                 : 0;  // otherwise 0: elements, which are valid for both models
  model.elements = std::max(one.elements, other.elements);
  if (other.step && (!one.step || *other.step < *one.step)) model.step = other.step;
  if (other.method != one.method) model.method = base::methods().front().name;
  if (other.vehicles == scene::VehicleModel::full) model.vehicles = scene::VehicleModel::full;
  model.residual_limit = std::min(one.residual_limit, other.residual_limit);
  model.trials_lost_contact |= other.trials_lost_contact;
  model.local_compliance |= other.local_compliance;
  model.step_probes |= other.step_probes;
  return model;
}

void set_mesh(Scene& scene, int elements) {
  beam::BeamModel& beam = *scene.beam;
  scene.model.elements = elements;
  if (beam.track) {
    beam.track->elements_per_bay = elements;
    return;
  }
  const double longest = *std::max_element(beam.spans.begin(), beam.spans.end());
  for (std::size_t i = 0; i < beam.spans.size(); ++i)
    beam.elements[i] = elements == 1
                           ? 1
                           : std::max(std::min(elements, min_elements),
                                      2 * base::whole(std::ceil(0.5 * elements * beam.spans[i] / longest - 1e-9)));
}

bool aligned(const Scene& scene, int elements) {
  std::vector<double> stations = scene.output.probes;
  for_points(scene.beam->foundation, [&](const beam::FoundationKind&, const auto& points) {
    for (const beam::PointFoundation& point : points) stations.push_back(point.x);
  });
  if (scene.beam->track || stations.size() > max_stations) return false;
  Scene trial = scene;
  set_mesh(trial, elements);
  return std::all_of(stations.begin(), stations.end(), [&](double x) { return is_node(*trial.beam, x); });
}

int aligned_mesh(const Scene& scene, int elements, double most) {
  for (int count = elements; count <= most * elements; count += 2)
    if (aligned(scene, count)) return count;
  return elements;
}

int mesh_of(const Scene& scene) {
  return scene.beam->track ? scene.beam->track->elements_per_bay
                           : *std::max_element(scene.beam->elements.begin(), scene.beam->elements.end());
}

}  // namespace traverse::error_control
