// Refines the number of modes by the search of companions. Runs by modes are exact in time, so that the only errors are
// those of the omitted modes and of the mesh that gives the modes. The cost by modes is estimated with the modes that
// EN 1990, A2.4.4.2.1 requires.
#include "error_control/mode_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include "ensemble/case_runner.hpp"
#include "error_control/accuracy.hpp"
#include "error_control/companion_search.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/mode_mesh.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/sweep_model.hpp"
#include "modes/modes.hpp"
#include "results/stage.hpp"
#include "run/rank_choice.hpp"
#include "traverse/options/input.hpp"

namespace traverse::error_control {

using ensemble::CaseResult;
using scene::Scene;

namespace {

constexpr double code_frequency = 30.0, code_factor = 1.5;  // Hz; factor of the first frequency
constexpr std::size_t code_modes = 3;
constexpr int max_required = 64, max_nodes = 1000;

/// The largest relative difference of low-passed accelerations with a limit.
double difference_low_passed(const Scene& scene, const CaseResult& rough, const CaseResult& fine) {
  double worst = 0.0;
  for (std::size_t i = 0; i < scene.limits.size(); ++i) {
    const double value = fine.evaluated[i].value;
    if (scene.limits[i].quantity == "deck_acceleration" && value > 0.0)
      worst = std::max(worst, std::abs(rough.evaluated[i].value / value - 1.0));
  }
  return worst;
}

/// Whether modes are allowed for the scene. read_modal has the same conditions.
bool modes_allowed(const Scene& scene) {
  return scene.vehicles.empty() && !scene.load.forces.empty() && scene.load.courses.empty() && !scene.beam->track &&
         !scene.beam->foundation.nonlinear() && !scene.beam->strained() && scene.find_option("ts_type") == nullptr;
}

/// Passages of a sweep by numbers of modes, in groups of neighbouring speeds that are evenly distributed over all
/// trains and speeds.
class ModeCompanions : public Companions {
 public:
  explicit ModeCompanions(const Scene& scene) : scene_(scene) {}

  bool run(const Discretisation& model) override {
    Passages& passages = passages_[model.elements];
    if (!passages.results.empty()) return true;
    ensemble::CaseRunner& runner = runner_of(model.elements);
    std::vector<ensemble::CaseRun> runs;
    for (const double speed : runner.speeds()) runs.push_back({speed, {}});
    const std::vector<std::vector<std::size_t>> groups = ensemble::group_runs(runs, runner.width());
    const std::size_t all = groups.size() * runner.trains(),
                      count = std::min(all, std::max<std::size_t>(1, search::mode_samples / runner.width()));
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t one = (2 * k + 1) * all / (2 * count);
      std::vector<ensemble::CaseRunner::Member> members;
      for (const std::size_t i : groups[one % groups.size()]) members.push_back({&runner, runs[i]});
      std::ranges::move(ensemble::CaseRunner::run_together(one / groups.size(), members),
                        std::back_inserter(passages.results));
    }
    return true;
  }
  PeakErrors change(const Discretisation& coarse, const Discretisation& fine) override {
    const std::vector<CaseResult>&rough = passages_[coarse.elements].results, &exact = passages_[fine.elements].results;
    PeakErrors changes{};
    for (std::size_t i = 0; i < exact.size(); ++i) {
      PeakErrors one = difference(scene_, rough[i], exact[i]);
      if (is_controlled(scene_, run::low_passed))
        one[run::low_passed] = difference_low_passed(scene_, rough[i], exact[i]);
      for (std::size_t q = 0; q < run::quantities; ++q) changes[q] = std::max(changes[q], one[q]);
    }
    return changes;
  }
  // The omitted modes follow a force without delay; with damping, their moment follows it with one.
  double weight(std::size_t q) const override {
    return q == run::acceleration ? search::weight_of_forces : q == run::moment ? search::weight_of_sum : 1.0;
  }
  double seconds(const Discretisation& model) override { return runner_of(model.elements).cost_of_all(); }
  /// The cost of all passages by elements with the first mesh and step that a search would try.
  double seconds_by_elements(int modes) {
    const ensemble::CaseRunner& runner = runner_of(modes);
    const double duration = runner.cost_of_all() / runner.cost(), omega = runner.beam()->modal->omega().front();
    return duration / first_steps(at_speed(scene_, runner.speeds().back()), omega, duration).first *
           run::step_seconds(scene_, {}, first_mesh(scene_));
  }

  /// The mesh that gives so many modes.
  int mesh(int modes) { return passages_[modes].mesh; }

 private:
  struct Passages {
    int mesh = 0;
    std::unique_ptr<ensemble::CaseRunner> runner;
    std::vector<CaseResult> results;
  };
  ensemble::CaseRunner& runner_of(int modes) {
    Passages& passages = passages_[modes];
    if (!passages.runner) {
      scene::NumericalModel model = scene_.model;
      model.modes = modes;
      passages.mesh = model.elements = scene_.mesh_open ? mesh_for(PETSC_COMM_SELF, scene_, modes) : mesh_of(scene_);
      std::vector<std::string> ignored;
      passages.runner = std::make_unique<ensemble::CaseRunner>(with(scene_, model), ignored);
    }
    return *passages.runner;
  }

  const Scene& scene_;
  std::map<int, Passages> passages_;
};

SearchTask task_of(const Scene& scene) {
  SearchTask task;
  task.accuracy = scene.accuracy;
  for (std::size_t q = 0; q < run::quantities; ++q)
    task.wanted[q] =
        is_controlled(scene, q) && !run::by_elements_only(q) && (q != run::acceleration || damps_high_modes(scene));
  task.coarse.elements = search::first_modes * static_cast<int>(scene.beam->spans.size());
  task.fine.elements = 2 * task.coarse.elements;
  task.most_elements = search::max_modes;
  task.unit = "modes";
  return task;
}

/// The modes that EN 1990, A2.4.4.2.1 requires.
QuickerModes required_modes(const beam::Beam& beam) {
  std::vector<double> frequencies;  // Hz, bending modes
  const modes::Modes found = modes::natural_modes(beam, max_required, false);
  for (std::size_t i = 0; i < found.omega.size(); ++i)
    if (found.motion[i] != modes::Motion::along && found.omega[i] > 0.0)
      frequencies.push_back(found.omega[i] / (2.0 * std::numbers::pi));
  if (frequencies.empty()) throw SolverError("the bridge has no mode of bending");
  const double wanted = std::max(code_frequency, code_factor * frequencies.front());
  const auto count_below = std::upper_bound(frequencies.begin(), frequencies.end(), wanted) - frequencies.begin();
  const auto count =
      std::min(std::max<std::size_t>(static_cast<std::size_t>(count_below), code_modes), frequencies.size());
  return {static_cast<int>(count), frequencies[count - 1], 0.0};
}

}  // namespace

std::optional<Choice> choose_modes(const Scene& scene, std::vector<std::string>& notes) {
  if (!scene.modes_open || scene.model.step || !modes_allowed(scene) || !chooses(at_speed(scene, 1.0))) return {};
  const results::Stage stage("trial runs by modes");
  const options::WithoutMonitors without_monitors;
  const auto begin = std::chrono::steady_clock::now();
  SearchTask task = task_of(scene);
  if (task.fine.elements > task.most_elements) return {};
  try {
    ModeCompanions runs(scene);
    task.affordable = search::max_price * runs.seconds_by_elements(task.coarse.elements);
    CompanionSearch search(runs, task);
    search.run();
    Choice choice{scene.model, {}, {}, {}};
    choice.model.modes = search.model().elements;
    choice.model.elements = runs.mesh(choice.model.modes);
    choice.accuracy.measured = true;
    for (std::size_t q = 0; q < run::quantities; ++q) {
      const std::string why = task.wanted[q]            ? search.why_not(q)
                              : is_controlled(scene, q) ? std::string(no_sum)
                                                        : why_not_controlled(scene, q);
      if (task.wanted[q] && !why.empty() && q != run::acceleration) return {};
      const bool present = q != run::wheel_force && (q <= run::moment || is_controlled(scene, q));
      choice.accuracy.estimates[q] = {present, why.empty(), search.errors()[q], why};
    }
    choice.accuracy.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    notes.push_back(
        fmt::format("accuracy {:g}: {} modes instead of the elements, of {} elements a span; trial runs took {:.2g} s; "
                    "-model_modes 0 selects the elements",
                    scene.accuracy, choice.model.modes, choice.model.elements, choice.accuracy.seconds));
    std::vector<std::string> lines = choice.accuracy.lines();
    std::ranges::move(lines, std::back_inserter(notes));
    return choice;
  } catch (const Error&) {
    return {};  // a floating bridge, too few modes, or a failing run: the sweep itself reports the error
  }
}

std::optional<QuickerModes> quicker_modes(const Scene& scene) {
  if (!modes_allowed(scene) || scene.model.modes > 0) return std::nullopt;
  try {
    std::vector<std::string> ignored;
    const run::SharedBeam shared(PETSC_COMM_SELF, scene, ignored);
    if (shared.beam->mesh().nodes() > max_nodes) return std::nullopt;
    const QuickerModes required = required_modes(*shared.beam);
    Scene by_modes = scene;
    by_modes.model.modes = required.modes;
    const ensemble::CaseRunner runner(by_modes, ignored);
    return QuickerModes{required.modes, required.frequency, runner.cost_of_all()};
  } catch (const Error&) {
    return std::nullopt;  // for example a floating bridge
  }
}

}  // namespace traverse::error_control
