// Entry point of the program: claims the output files and calls the application that the scene asks for, or describes
// the scene. For one run it chooses the numerical model and the number of MPI ranks.
#include "traverse/app/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "analyses.hpp"
#include "applications.hpp"
#include "base/notes.hpp"
#include "check/check.hpp"
#include "check/unusual.hpp"
#include "error_control/trial_runs.hpp"
#include "fit/fit.hpp"
#include "prepare.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/checkpoints.hpp"
#include "run/passage.hpp"
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
      !viaduct || scene.vehicles.empty() || !scene.train.driven() || scene.start != scene::Start::equilibrium)
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

/// One run, or another analysis of one scene. The number of ranks is selected before the trial runs, and again for the
/// model that they select.
int run_one(Request request) {
  const std::optional<results::Checkpoint>& earlier = request.earlier;
  const run::RankChoice at_first = ranks_for(request.comm, request.scene, earlier);
  const auto serve = [&](MPI_Comm all, const scene::NumericalModel& model) {
    run::serve_trains(all, error_control::with(request.scene, model));
  };
  const auto work = [&](MPI_Comm some, run::WaitingRanks* waiting) {
    scene::Scene scene = request.scene;
    std::vector<std::string> notes;
    std::optional<OpenChoice> open;
    const error_control::Accuracy accuracy = choose_model(some, scene, notes, &open);
    take_linear_vehicles(scene, notes);
    const run::RankChoice ranks = ranks_for(some, scene, earlier);
    if (const std::string& said = ranks.note.empty() ? at_first.note : ranks.note; !said.empty()) notes.push_back(said);
    const auto work_on = [&](MPI_Comm fewer, run::WaitingRanks* more) {
      run::SharedBeam shared(fewer, scene, notes);
      notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
      return run_of(scene.analysis)
          ->run({fewer, scene, std::move(request.place), accuracy, open ? &*open : nullptr, shared, std::move(notes),
                 earlier ? &*earlier : nullptr, more != nullptr ? more : waiting});
    };
    return run::run_on_first(some, ranks.ranks, work_on, serve);
  };
  return run::run_on_first(request.comm, at_first.ranks, work, serve);
}

constexpr Application applications[] = {
    {"screen", "a screen (scene_analysis screen)", [](const scene::Scene& scene) { return scene.screen.has_value(); },
     run_one, check_screen},
    {"fit", "a fit (fit_vary)", [](const scene::Scene& scene) { return scene.fit.has_value(); },
     [](Request request) { return fit::run_fit(request.comm, request.scene, std::move(request.place)); },
     check::run_check},
    {"study", "a study or a sweep (study_vary, find_option, sweep_speed)",
     [](const scene::Scene& scene) { return scene.study || scene.sweep; },
     [](Request request) { return study::run_study(request.comm, request.scene, std::move(request.place)); },
     check::run_check},
    {"run", "one run", [](const scene::Scene&) { return true; }, run_one, check::run_check},
};

}  // namespace

const Application& application_of(const scene::Scene& scene) {
  return *std::ranges::find_if(applications, [&](const Application& one) { return one.is_asked(scene); });
}

bool is_verb(std::string_view word) {
  return word == "describe" || std::ranges::find(applications, word, &Application::verb) != std::end(applications);
}

void check_verb(std::string_view verb, const scene::Scene& scene) {
  const auto* wanted = std::ranges::find(applications, verb, &Application::verb);
  const Application& own = application_of(scene);
  if (wanted != std::end(applications) && wanted->verb != own.verb)
    throw InputError(fmt::format("traverse {}: {} is not {} but {}; traverse {} computes it", verb, scene.name,
                                 wanted->what, own.what, own.verb));
}

int run(MPI_Comm comm, const scene::Scene& given) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const results::Heartbeat heartbeat(given.quiet || rank != 0);
  const Application& application = application_of(given);
  if (given.describe) return application.describe(comm, given);
  if ((given.study || given.fit) && scene::has_own_contact_law(given))
    throw InputError(fmt::format("{}: its scenes are read from the options, without contact laws of the program",
                                 given.study ? "study_vary" : "fit_vary"));
  scene::Scene asked = given;
  const std::optional<results::Checkpoint> earlier = run::earlier_of(comm, asked);
  results::Place place = run::claim_outputs(comm, asked);
  if (!earlier) say_unusual(asked);
  return application.run({comm, asked, std::move(place), earlier});
}

}  // namespace traverse::app
