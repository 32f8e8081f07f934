// Chooses the model of a study by its extreme scenes, or reads it from the cache, and computes the runs in memory.
#include "study/prepared_study.hpp"

#include <algorithm>
#include <utility>

#include "base/broadcast.hpp"
#include "error_control/choice_cache.hpp"
#include "error_control/sweep_model.hpp"
#include "study/local_steps.hpp"
#include "study/study_model.hpp"
#include "study/study_runs.hpp"

namespace traverse::study {

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
  if (cache.read(given, notes, found)) return found;
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
