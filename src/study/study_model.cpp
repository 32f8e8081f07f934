// Chooses the model at the scenes with the extreme values of every varied option, and combines the choices into the
// finest of each.
#include "study/study_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "error_control/trial_runs.hpp"

namespace traverse::app {
namespace {

using Choose = std::optional<Choice> (*)(const Scene& scene, std::vector<std::string>& notes);

std::optional<Choice> one_by_one(const Scene& scene, std::vector<std::string>& notes) {
  return choose_one_by_one(scene, notes);
}

/// At all of the study's extreme scenes; nothing where one of them refuses.
std::optional<Choice> choose_at_extremes(const StudyScenes& scenes, Choose choose, std::vector<std::string>& notes) {
  const std::vector<std::size_t> bases = scenes.extreme_bases();
  std::optional<Choice> all;
  for (const std::size_t base : bases) {
    std::vector<std::string> own;
    const std::optional<Choice> one = choose(scenes.base(base), own);
    if (bases.size() > 1 && !own.empty()) notes.push_back(fmt::format("scene {} of {}:", base + 1, scenes.bases()));
    notes.insert(notes.end(), own.begin(), own.end());
    if (!one) return std::nullopt;
    if (all) {
      all->model = finer(all->model, one->model);
      all->accuracy.merge(one->accuracy);
    } else {
      all = one;
    }
  }
  return all;
}

}  // namespace

Choice choose_for_study(const StudyScenes& scenes, std::vector<std::string>& notes) {
  if (std::optional<Choice> choice = choose_at_extremes(scenes, choose_side_by_side, notes)) return *choice;
  return *choose_at_extremes(scenes, one_by_one, notes);
}

}  // namespace traverse::app
