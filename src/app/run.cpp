// Entry point of the program's analyses: claims the output files, chooses the numerical model and the number of MPI
// ranks, and calls the analysis that the scene asks for, the check of the scene, or the study.
#include "traverse/app/run.hpp"

#include <fmt/format.h>

#include "analyses.hpp"
#include "base/notes.hpp"
#include "check/check.hpp"
#include "check/unusual.hpp"
#include "error_control/trial_runs.hpp"
#include "fit/fit.hpp"
#include "prepare.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/active_ranks.hpp"
#include "run/checkpoints.hpp"
#include "run/rank_choice.hpp"
#include "study/study.hpp"
#include "traverse/base/error.hpp"

namespace traverse::app {

namespace {

/// Selects linear vehicles on viaducts with separate spans. There the vehicles cause nearly all the cost of a time
/// step, and linear vehicles cost a fraction of mechanisms. The linearisation residual is computed; if it exceeds its
/// limit, the run is repeated with the mechanisms.
void take_linear_vehicles(scene::Scene& scene, std::vector<std::string>& notes) {
  const bool viaduct = scene.beam && scene.beam->all_separate() && scene.beam->spans.size() > 1;
  if (scene.model.vehicles != scene::VehicleModel::automatic || scene.analysis != options::Analysis::transient ||
      !viaduct || scene.vehicles.empty() || !scene.train.steady() || scene.start != scene::Start::equilibrium)
    return;
  scene.model.vehicles = scene::VehicleModel::linear;
  scene.model.residual_limit = error_control::default_residual_limit(scene);
  notes.push_back(
      base::detail(fmt::format("vehicles are linearised as long as the residual is below {:.1g} of their weights; "
                               "-model_vehicles full keeps the mechanisms",
                               scene.model.residual_limit)));
}

/// The number of ranks. A continued run has the same number as before, if as many ranks are available as before.
run::RankChoice ranks_for(MPI_Comm comm, const scene::Scene& scene, const std::optional<results::Checkpoint>& earlier) {
  run::RankChoice all;
  MPI_Comm_size(comm, &all.ranks);
  if (earlier && (all.ranks == earlier->given_ranks || all.ranks == static_cast<int>(earlier->of_ranks.size()))) {
    all.ranks = static_cast<int>(earlier->of_ranks.size());
    return all;
  }
  return scene.analysis == options::Analysis::transient ? run::choose_ranks(comm, scene) : all;
}

/// Adds what is unusual in the scene to its notes and prints all of it, before the first computation.
void say_unusual(scene::Scene& scene) {
  if (scene.screen) return;  // its stock is read later
  for (std::string& line : check::unusual_in(scene)) {
    scene.notes.push_back(line);
    scene.unusual.push_back(std::move(line));
  }
  results::print_unusual(scene.unusual);
}

}  // namespace

int run(MPI_Comm comm, const scene::Scene& given) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const results::Heartbeat heartbeat(given.quiet || rank != 0);
  if (given.describe) return given.screen ? check_screen(comm, given) : check::run_check(comm, given);
  if ((given.study || given.fit) && scene::has_own_contact_law(given))
    throw InputError(fmt::format("{}: its scenes are read from the options, without contact laws of the program",
                                 given.study ? "study_vary" : "fit_vary"));
  scene::Scene asked = given;
  const std::optional<results::Checkpoint> earlier = run::earlier_of(comm, asked);
  results::Place place = run::claim_outputs(comm, asked);
  if (!earlier) say_unusual(asked);
  if (asked.fit) return fit::run_fit(comm, asked, std::move(place));
  if (asked.study || asked.sweep) return study::run_study(comm, asked, std::move(place));
  // The number is selected before the trial runs, and again for the model that they select.
  const run::RankChoice at_first = ranks_for(comm, given, earlier);
  return run::run_on_first(comm, at_first.ranks, [&](MPI_Comm some) {
    scene::Scene scene = asked;
    std::vector<std::string> notes;
    const error_control::Accuracy accuracy = choose_model(some, scene, notes);
    take_linear_vehicles(scene, notes);
    const run::RankChoice ranks = ranks_for(some, scene, earlier);
    if (const std::string& said = ranks.note.empty() ? at_first.note : ranks.note; !said.empty()) notes.push_back(said);
    return run::run_on_first(some, ranks.ranks, [&](MPI_Comm fewer) {
      run::SharedBeam shared(fewer, scene, notes);
      notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
      return run_of(scene.analysis)
          ->run({fewer, scene, std::move(place), accuracy, shared, std::move(notes), earlier ? &*earlier : nullptr});
    });
  });
}

}  // namespace traverse::app
