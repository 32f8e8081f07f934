// Searches mesh and step on whole passages at the slowest, a middle and the fastest speeds, side by side, then a method
// with fewer solves in each step.
#include "error_control/batch_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/one_step_methods.hpp"
#include "engine/speed_class.hpp"
#include "error_control/accuracy.hpp"
#include "error_control/batch_trial_runs.hpp"
#include "error_control/companion_search.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/linearisation_error.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/sweep_model.hpp"
#include "results/stage.hpp"
#include "run/rank_choice.hpp"
#include "traverse/options/input.hpp"

namespace traverse::error_control {

using scene::NumericalModel;

namespace {

constexpr std::size_t min_runs_in_batches = 4, trial_lanes = 4;

/// The reason why nothing was chosen.
struct NotChosen {
  std::string why;
};

bool open(const scene::Scene& scene) {
  return !scene.vehicles.empty() && scene.train.courses.empty() && !scene.model.step && scene.model.modes == 0 &&
         scene.mesh_open && scene.model.vehicles != scene::VehicleModel::full && scene.beam &&
         scene.find_option("ts_type") == nullptr;
}

/// Groups of neighbouring speeds of one step group, around the slowest, a middle and the fastest speed.
std::vector<std::vector<double>> trial_speeds(const std::vector<double>& speeds) {
  std::vector<std::vector<double>> groups;
  for (const double place : {0.0, 0.5, 1.0}) {
    const auto at = static_cast<std::size_t>(place * static_cast<double>(speeds.size() - 1));
    const int number = engine::speed_class(speeds[at]);
    std::vector<double> group;
    for (std::size_t i = at; i < speeds.size() && group.size() < trial_lanes; ++i)
      if (engine::speed_class(speeds[i]) == number) group.push_back(speeds[i]);
    for (std::size_t i = at; i > 0 && group.size() < trial_lanes; --i)
      if (engine::speed_class(speeds[i - 1]) == number) group.push_back(speeds[i - 1]);
    std::sort(group.begin(), group.end());
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  return groups;
}

/// The sweep's scene at its fastest speed.
scene::Scene fastest(const scene::Scene& sweep) {
  scene::Scene scene = at_speed(sweep, sweep.sweep->speeds.back());
  scene.sweep.reset();
  return scene;
}

/// The length of a passage, m: to the last wheel's exit at the fastest speed, and the tail.
double length_of_passage(const scene::Scene& scene) {
  double length = 0.0;
  for (const double x : scene::wheels_at_start(scene)) length = std::max(length, scene.beam->length() - x);
  return scene.end_time ? *scene.end_time * scene.train.speed : length + scene.tail.value_or(0.0) * scene.train.speed;
}

class BatchCompanions : public Companions {
 public:
  explicit BatchCompanions(const scene::Scene& scene)
      : fastest_(fastest(scene)),
        duration_(length_of_passage(fastest_) / fastest_.train.speed),
        trials_(scene, trial_speeds(scene.sweep->speeds), length_of_passage(fastest_)) {}

  bool run(const Discretisation& model) override {
    return std::ranges::all_of(results(model),
                               [](const engine::BatchResult& one) { return one.failure == engine::none; });
  }
  PeakErrors change(const Discretisation& coarse, const Discretisation& fine) override {
    return difference(trials_.scene(), results(coarse), results(fine));
  }
  double weight(std::size_t q) const override {
    // Without damping a moment is a sum of 1/n^2 over all modes, of which a step resolves those below a frequency.
    return q == run::moment && !damps_high_modes(trials_.scene()) ? search::weight_of_sum : 1.0;
  }
  double seconds(const Discretisation& model) override {
    return duration_ / model.step * run::step_seconds(fastest_, {}, model.elements);
  }
  int mesh_of_at_least(int elements) const override { return aligned_mesh(fastest_, 2 * ((elements + 1) / 2)); }

  NumericalModel model_of(const Discretisation& one, const char* method = base::methods().front().name) const {
    NumericalModel model = trials_.scene().model;
    model.elements = one.elements;
    model.step = one.step;
    model.modes = 0;
    model.method = method;
    model.vehicles = scene::VehicleModel::linear;
    return model;
  }
  BatchTrialRuns& trials() { return trials_; }
  const scene::Scene& fastest_scene() const { return fastest_; }
  double duration() const { return duration_; }  // s, of the fastest passage

 private:
  const std::vector<engine::BatchResult>& results(const Discretisation& model) { return trials_.run(model_of(model)); }

  scene::Scene fastest_;
  double duration_;
  BatchTrialRuns trials_;
};

/// The reason why a quantity has no estimate whatever mesh and step are; empty: none.
std::string why_not(const scene::Scene& scene, std::size_t q) {
  if (!is_controlled(scene, q)) return why_not_controlled(scene, q);
  return q == run::acceleration && !damps_high_modes(scene) ? no_sum : "";
}

SearchTask task_of(const scene::Scene& scene, BatchCompanions& runs) {
  SearchTask task;
  task.accuracy = scene.accuracy;
  for (std::size_t q = 0; q < run::quantities; ++q) task.wanted[q] = why_not(scene, q).empty();
  scene::Scene first = runs.fastest_scene();
  set_first_mesh(first);
  task.fine.elements = mesh_of(first);
  task.coarse.elements = task.fine.elements / 2;
  const double omega = runs.trials().first_omega(runs.model_of({task.fine.elements, 1.0}));
  const FirstSteps steps = first_steps(runs.fastest_scene(), omega, runs.duration());
  task.coarse.step = std::min(search::first_ratio * steps.first, 2.0 * steps.longest);
  task.fine.step = 0.5 * task.coarse.step;
  task.most_elements = search::max_in_a_span;
  return task;
}

/// The cheapest method with fewer solves in each step, and its step, whose peaks are within the accuracy too; their
/// errors are returned in `errors`.
NumericalModel with_cheaper_method(BatchCompanions& runs, const Discretisation& found, PeakErrors& errors) {
  const scene::Scene& scene = runs.trials().scene();
  const NumericalModel exact = runs.model_of(found);
  const auto within = [&](const PeakErrors& changes) {
    for (std::size_t q = 0; q < run::quantities; ++q)
      if (changes[q] > std::max(scene.accuracy, errors[q])) return false;
    return true;
  };
  const auto solves = [](const base::MethodRow& method, double step) { return method.solves() / step; };
  NumericalModel best = exact;
  double least = solves(base::methods().front(), found.step);
  for (const base::MethodRow& method : base::methods().subspan(1)) {
    // With one solve in each step wheel forces have errors where the step length changes.
    if (method.solves() == 1.0 && controls_forces_only(scene)) continue;
    for (const double factor : search::batch_steps) {
      const NumericalModel other = runs.model_of({found.elements, factor * found.step}, method.name);
      if (solves(method, *other.step) >= least) break;
      PeakErrors changes = difference(scene, runs.trials().run(other), runs.trials().run(exact));
      const double one_solve = method.solves() > 1.0 ? 1.0 : search::one_solve;
      for (std::size_t q = 0; q < run::quantities; ++q)
        changes[q] = errors[q] + one_solve *
                                     (q == run::wheel_force && one_solve > 1.0 ? search::one_solve_force : 1.0) *
                                     changes[q];
      if (!within(changes)) continue;
      best = other;
      least = solves(method, *other.step);
      errors = changes;
      break;
    }
  }
  return best;
}

Choice search_batches(const scene::Scene& scene) {
  BatchCompanions runs(scene);
  const SearchTask task = task_of(scene, runs);
  CompanionSearch search(runs, task);
  search.run();
  PeakErrors errors = search.errors();
  Choice choice{with_cheaper_method(runs, search.model(), errors), {}, {}, {}};
  if (any_contact_loss(runs.trials().run(choice.model))) throw NotChosen{"wheels lose contact"};
  if (scene.model.vehicles == scene::VehicleModel::automatic) {
    const double residual = runs.trials().residual(choice.model);
    choice.model.residual_limit =
        may_exceed(residual, scene)
            ? measured_residual_limit(PETSC_COMM_SELF, with(runs.fastest_scene(), runs.model_of(search.model())))
            : default_residual_limit(scene);
    if (residual > choice.model.residual_limit)
      throw NotChosen{fmt::format("the residual of linearised vehicles is {:.1g} of their weights", residual)};
    for (double& error : errors) error += std::min(residual, default_residual_limit(scene));
  }
  choice.model.step_probes = true;
  choice.model.local_compliance = true;
  choice.accuracy.measured = true;
  for (std::size_t q = 0; q < run::quantities; ++q) {
    const bool present = !run::by_elements_only(q) || q == run::shear_force;
    const std::string why = task.wanted[q] ? search.why_not(q) : why_not(scene, q);
    choice.accuracy.estimates[q] = {present, why.empty(), errors[q], why};
  }
  return choice;
}

}  // namespace

std::optional<Choice> choose_batch_model(const scene::Scene& scene, std::vector<std::string>& notes) {
  if (!open(scene) || scene.sweep->lanes == 0 ||
      std::max(scene.sweep->runs, scene.sweep->speeds.size()) < min_runs_in_batches)
    return std::nullopt;
  const results::Stage stage("batched trial runs");
  const options::WithoutMonitors without_monitors;
  const auto reject = [&](const std::string& why) {
    notes.push_back("batched trial runs found no common mesh and step: " + why);
    return std::nullopt;
  };
  try {
    Choice choice = search_batches(scene);
    notes.push_back(fmt::format("batched runs: {} elements a span, linear vehicles, {} with steps of {:.3g} s or less",
                                choice.model.elements, choice.model.method, *choice.model.step));
    std::ranges::move(choice.accuracy.lines(), std::back_inserter(notes));
    return choice;
  } catch (const NotChosen& none) {
    return reject(none.why);
  } catch (const BatchTrialRuns::Refused& refused) {
    return reject(refused.why);
  } catch (const Error& failed) {
    return reject(failed.what());  // the single runs will report this error too, if it is their own
  }
}

}  // namespace traverse::error_control
