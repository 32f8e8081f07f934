// Chooses the model at the scenes with the extreme values of every varied option, and combines the finest mesh, step
// and number of modes.
#include "study/study_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "error_control/trial_runs.hpp"

namespace traverse::study {
namespace {

using Choose = std::optional<error_control::Choice> (*)(const scene::Scene& scene, std::vector<std::string>& notes);

std::optional<error_control::Choice> unbatched(const scene::Scene& scene, std::vector<std::string>& notes) {
  return error_control::choose_unbatched(scene, notes);
}

/// The combined choice for the study's extreme scenes; empty if `choose` is not applicable to one of them.
std::optional<error_control::Choice> choose_at_extremes(const StudyScenes& scenes, Choose choose,
                                                        std::vector<std::string>& notes) {
  const std::vector<std::size_t> bases = scenes.bases_of_model();
  std::optional<error_control::Choice> all;
  std::vector<std::vector<std::string>> notes_of_bases;
  for (const std::size_t base : bases) {
    std::vector<std::string> own;
    const std::optional<error_control::Choice> one = choose(scenes.base(base), own);
    if (!one) {
      notes.insert(notes.end(), own.begin(), own.end());
      return std::nullopt;
    }
    notes_of_bases.push_back(std::move(own));
    if (all) {
      all->model = error_control::finer(all->model, one->model);
      all->accuracy.merge(one->accuracy);
    } else {
      all = one;
    }
  }
  const bool same = std::equal(notes_of_bases.begin() + 1, notes_of_bases.end(), notes_of_bases.begin());
  for (std::size_t i = 0; i < (same ? 1 : bases.size()); ++i) {
    const std::vector<std::string>& own = notes_of_bases[i];
    if (!same && !own.empty()) notes.push_back(fmt::format("scene {} of {}:", bases[i] + 1, scenes.bases()));
    notes.insert(notes.end(), own.begin(), own.end());
  }
  return all;
}

}  // namespace

error_control::Choice choose_for_study(const StudyScenes& scenes, std::vector<std::string>& notes) {
  if (std::optional<error_control::Choice> choice = choose_at_extremes(scenes, error_control::choose_batched, notes))
    return *choice;
  return *choose_at_extremes(scenes, unbatched, notes);
}

}  // namespace traverse::study
