#include "study/study_choice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "accuracy/trials.hpp"

namespace traverse::app {
namespace {

/// What serves both: the finer mesh and the shorter step, more modes, the method of higher order.
void join(const SweepChoice& one, SweepChoice& all) {
  Scene& scene = all.scene;
  const Scene& other = one.scene;
  if ((scene.model_modes > 0) != (other.model_modes > 0)) {  // elements serve where modes do not
    if (other.model_modes == 0) all = one;
    return;
  }
  set_mesh(scene, std::max(mesh_of(scene), mesh_of(other)));
  scene.model_modes = std::max(scene.model_modes, other.model_modes);
  if (other.time_step && (!scene.time_step || *other.time_step < *scene.time_step)) scene.time_step = other.time_step;
  if (scene.sweep->method != other.sweep->method) scene.sweep->method = "esdirk4";
  if (other.vehicle_model == VehicleModel::full) scene.vehicle_model = VehicleModel::full;
  scene.most_defect = std::min(scene.most_defect, other.most_defect);
  results::Sweep::Model& model = all.model;
  model.modes = scene.model_modes;
  model.elements = std::max(model.elements, one.model.elements);
  if (model.time_step > 0.0) model.time_step = *scene.time_step;
  model.method = scene.sweep->method;
  for (const auto& [quantity, error] : one.model.expected_errors)
    for (auto& [known, largest] : model.expected_errors)
      if (known == quantity) largest = std::max(largest, error);
}

}  // namespace

SweepChoice choose_for_study(const StudyScenes& scenes, std::vector<std::string>& notes) {
  const std::vector<std::size_t> bases = scenes.extreme_bases();
  std::optional<SweepChoice> all;
  for (const std::size_t base : bases) {
    std::vector<std::string> own;
    const SweepChoice one = choose_for_sweep(scenes.base(base), own);
    if (bases.size() > 1 && !own.empty()) notes.push_back(fmt::format("scene {} of {}:", base + 1, scenes.bases()));
    notes.insert(notes.end(), own.begin(), own.end());
    if (all)
      join(one, *all);
    else
      all = one;
  }
  return *all;
}

}  // namespace traverse::app
