// Chooses the model of a study, mesh, step and modes as far as the scene leaves them open, at the scenes with the
// extreme values of every varied option, or reads it from the cache, and computes the runs in memory. In a local
// sensitivity analysis the runner of one point of each factor is compared with that of the nominal point, to choose the
// steps of its differences.
#include "study/prepared_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/broadcast.hpp"
#include "base/sampling_design.hpp"
#include "error_control/choice_cache.hpp"
#include "error_control/sweep_model.hpp"
#include "error_control/trial_runs.hpp"
#include "study/study_runs.hpp"

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

/// The finest model that the study's extreme scenes need, each computed as a sweep over all speeds of the study. The
/// result is the same on every rank.
error_control::Choice choose_for_study(const StudyScenes& scenes, std::vector<std::string>& notes) {
  if (std::optional<error_control::Choice> choice = choose_at_extremes(scenes, error_control::choose_batched, notes))
    return *choice;
  return *choose_at_extremes(scenes, unbatched, notes);
}

/// Reduces the step of a local analysis for each factor whose runs are in one batch with the nominal point. Runs of a
/// batch have the same steps in distance, so that their results are smooth functions of the factor: differences over a
/// small step are derivatives to about six digits. Runs outside batches need the step of the design, because their own
/// steps, and so their errors, differ.
void reduce_local_steps(StudyScenes& scenes) {
  options::Study study = scenes.study();
  if (!study.sensitivity || study.sensitivity->method != options::Sensitivity::Method::local) return;
  const StudyScenes::Runner nominal = scenes.runner(0);
  if (!nominal.runs->has_lanes()) return;
  const std::size_t axis = study.sensitivity->axis;
  const auto base_of = [&](std::size_t point) {
    std::size_t run = 0;
    while (scenes.study().place(run, axis) != point) ++run;
    return scenes.runs()[run].base;
  };
  std::size_t point = 1;  // the first point of the factor
  for (options::StudyDimension& d : study.dimensions) {
    if (d.axis != axis) continue;
    if (StudyScenes::compatible(scenes.runner(base_of(point)), nominal))
      for (double& value : d.values)
        value = d.values.front() + (value - d.values.front()) * base::batch_step / base::local_step;
    point += base::local_points_per_factor;
  }
  scenes.enumerate(study);
}

}  // namespace

PreparedStudy::PreparedStudy(MPI_Comm comm, const scene::Scene& given, StudyScenes::Read read)
    : scenes(given, std::move(read)),
      choice(chosen(comm, given)),
      scene(error_control::with(scenes.base(scenes.extreme_bases().front()), choice.model)),
      model(error_control::stored_model(scene, choice.accuracy)) {
  scenes.choose(choice.model);
  first = scenes.runner(0, &notes).runs;
  std::vector<std::string> of_others;
  for (const std::size_t base : scenes.bases_of_model()) scenes.runner(base, &of_others);
  reduce_local_steps(scenes);
}

error_control::Choice PreparedStudy::chosen(MPI_Comm comm, const scene::Scene& given) {
  for (const std::size_t base : scenes.extreme_bases())
    scenes.base(base);  // checks all input before the first computation
  error_control::Choice found;
  error_control::ChoiceCache cache(comm, given);
  if (cache.read(given, notes, found)) {
    notes.insert(notes.begin(), error_control::ChoiceCache::said);
    return found;
  }
  found = choose_for_study(scenes, notes);
  if (found.accuracy.measured) cache.write(notes, found);
  return found;
}

ensemble::RunFailure PreparedStudy::compute(MPI_Comm comm, const std::function<void()>& stored) {
  table_.emplace(scenes.study(), scene.output.probes.size(), has_wheels(scene), scene.limits);
  const std::vector<char> none_known(scenes.runs().size(), 0);
  ensemble::RunFailure failure = compute_runs(comm, scenes, none_known, *table_, stored);
  table_->broadcast(comm);
  return failure;
}

bool has_wheels(const scene::Scene& scene) {
  return std::any_of(scene.vehicles.begin(), scene.vehicles.end(),
                     [](const train::Vehicle& v) { return !v.wheels.empty(); });
}

}  // namespace traverse::study
