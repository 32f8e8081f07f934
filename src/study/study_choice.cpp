#include "study/study_choice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "accuracy/trials.hpp"

namespace traverse::app {
namespace {

constexpr double tighter = 0.5;  // of the accuracy: modes that are too few by little at one scene

/// What serves both: the finer mesh and the shorter step, more modes, the method of higher order.
void join(const SweepChoice& one, SweepChoice& all) {
  Scene& scene = all.scene;
  const Scene& other = one.scene;
  if (other.model_modes == 0) scene.model_modes = 0;  // elements serve where modes do not
  set_mesh(scene, std::max(mesh_of(scene), mesh_of(other)));
  if (scene.model_modes > 0) scene.model_modes = std::max(scene.model_modes, other.model_modes);
  if (other.time_step && (!scene.time_step || *other.time_step < *scene.time_step)) scene.time_step = other.time_step;
  if (scene.sweep->method != other.sweep->method) scene.sweep->method = "esdirk4";
  if (other.vehicle_model == VehicleModel::full) scene.vehicle_model = VehicleModel::full;
  scene.most_defect = std::min(scene.most_defect, other.most_defect);
  results::Sweep::Model& model = all.model;
  model.modes = scene.model_modes;
  model.elements = std::max(model.elements, one.model.elements);
  if (model.time_step > 0.0) model.time_step = *scene.time_step;
  model.method = scene.sweep->method;
  scene.sweep->trials_reach = std::min(scene.sweep->trials_reach, other.sweep->trials_reach);
  scene.sweep->trials_lost_contact |= other.sweep->trials_lost_contact;
  // What is promised of all is what both promise, with the larger error.
  std::erase_if(model.expected_errors, [&](auto& promise) {
    const auto& others = one.model.expected_errors;
    const auto same =
        std::find_if(others.begin(), others.end(), [&](const auto& o) { return o.first == promise.first; });
    if (same != others.end()) promise.second = std::max(promise.second, same->second);
    return same == others.end();
  });
}

using Choose = std::optional<SweepChoice> (*)(const Scene& scene, std::vector<std::string>& notes);

std::optional<SweepChoice> side_by_side(const Scene& scene, std::vector<std::string>& notes) {
  if (std::optional<SweepChoice> choice = choose_side_by_side(scene, notes)) return choice;
  if (notes.empty()) return {};  // the scene does not leave it open
  Scene strict = scene;
  strict.accuracy *= tighter;
  notes.push_back(fmt::format("once more, with an accuracy of {:g}:", strict.accuracy));
  std::optional<SweepChoice> choice = choose_side_by_side(strict, notes);
  if (!choice) return choice;
  choice->scene.accuracy = choice->model.accuracy = scene.accuracy;
  return choice;
}

std::optional<SweepChoice> one_by_one(const Scene& scene, std::vector<std::string>& notes) {
  return choose_one_by_one(scene, notes);
}

/// At all of the study's extreme scenes; nothing where one of them refuses.
std::optional<SweepChoice> choose_at_extremes(const StudyScenes& scenes, Choose choose,
                                              std::vector<std::string>& notes) {
  const std::vector<std::size_t> bases = scenes.extreme_bases();
  std::optional<SweepChoice> all;
  for (const std::size_t base : bases) {
    std::vector<std::string> own;
    const std::optional<SweepChoice> one = choose(scenes.base(base), own);
    if (bases.size() > 1 && !own.empty()) notes.push_back(fmt::format("scene {} of {}:", base + 1, scenes.bases()));
    notes.insert(notes.end(), own.begin(), own.end());
    if (!one) return std::nullopt;
    if (all)
      join(*one, *all);
    else
      all = one;
  }
  return all;
}

}  // namespace

SweepChoice choose_for_study(const StudyScenes& scenes, std::vector<std::string>& notes) {
  if (std::optional<SweepChoice> choice = choose_at_extremes(scenes, side_by_side, notes)) return *choice;
  return *choose_at_extremes(scenes, one_by_one, notes);
}

}  // namespace traverse::app
