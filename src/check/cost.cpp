// Estimates run time, memory and file size: the number of steps times the measured time of a step, with factors for the
// trial runs.
#include "cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/one_step_methods.hpp"
#include "beam/layered_track.hpp"
#include "ensemble/case_runner.hpp"
#include "error_control/accuracy.hpp"
#include "error_control/mode_search.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"
#include "results/terminal.hpp"
#include "run/outputs.hpp"
#include "run/rank_choice.hpp"
#include "scene/limits.hpp"
#include "structure/active_window.hpp"
#include "traverse/options/input.hpp"

namespace traverse::check {
namespace {

// Measured values; benchmarks/check_estimates.py compares the estimates with measurements.
constexpr double program_bytes = 6.5e7;  // bytes, of the program with its libraries
constexpr double spans_of_load = 4.0;    // number of active spans at the ends of a train on a long bridge
// Number of times that a stage is solved if sleepers slide along the track, and share of the steps in which their
// springs change, so that the matrix is factored again.
constexpr double sliding_solves = 6.0, sliding_factors = 0.3;
constexpr double petsc_factor = 2.0;     // ratio of the cost to the cost of the program's own integrators
constexpr double equivalent_runs = 2.5;  // number of runs with the first step that cost as much as all trial runs
// Ratio of the necessary number of modes to the number of EN 1990, with and without low-pass of the accelerations.
constexpr double modes_low_passed = 4.0, modes_unfiltered = 10.0;
constexpr double bytes_per_number = 8.0;
constexpr double bytes_per_peak = 200.0;  // bytes for each run of a sweep and probe

/// Accuracy below which trial runs refine the first mesh and step, whose errors are of this order.
constexpr double refined_below = 1e-3;
double refinement(const FirstRun& run) {
  return run.has_trial_runs
             ? std::max(1.0, std::pow(refined_below / run.scene.accuracy, 1.0 / error_control::search::full_order))
             : 1.0;
}

/// Part of a long bridge that moves: under each train, and behind it until the vibration has decayed.
double moving_part(const FirstRun& run) {
  const scene::Scene& scene = run.scene;
  if (!scene.beam || run::stage_work(scene).cut) return 1.0;
  const auto ratios = run.shared->damping_ratios();
  const double decay = ratios.empty() ? 0.0 : (ratios.front().beam + ratios.front().dampers) * ratios.front().omega;
  const double quiet = -std::log(structure::ActiveWindow::quiet);
  const double trail =
      scene::greatest_speed(scene) * (decay > 0.0 ? std::min(quiet / decay, run.end_time()) : run.end_time());
  const double span = scene.beam->length() / static_cast<double>(scene.beam->spans.size());
  std::vector<double> loads = scene::wheels_at_start(scene);
  loads.insert(loads.end(), scene.load.positions.begin(), scene.load.positions.end());
  std::sort(loads.begin(), loads.end());
  const double alone = trail + spans_of_load * span;
  double moving = alone;
  for (std::size_t i = 1; i < loads.size(); ++i) moving += std::min(loads[i] - loads[i - 1], alone);
  return std::min(1.0, moving / scene.beam->length());
}

/// Computing times of a step and of a factorisation for another length of it, s.
struct StepSeconds {
  double step = 0.0, factorisation = 0.0;
  double of(const integrate::StepCount& count) const { return count.steps * step + count.lengths * factorisation; }
};

StepSeconds step_seconds(const FirstRun& run) {
  const scene::Scene& scene = run.scene;
  if (scene.exact_in_time())
    return {run.simulation->passage().instants() *
            run::modal_sample_seconds(static_cast<double>(run.shared->modal->modes()), run.bridge()->local_unknowns(),
                                      run.shared->modal->dampers_couple())};
  const options::Entry* type = scene.find_option("ts_type");
  const std::string method = type == nullptr ? scene.model.method : type->value;
  const bool by_petsc = type != nullptr && base::find_method(method) == nullptr;
  const double factor = by_petsc ? petsc_factor : 1.0, moving = moving_part(run);
  scene::Scene alone = scene;
  alone.train.vehicles.clear();
  const double factorisation = factor * run::steps_per_factorisation * run::step_seconds(alone, method, 0, moving);
  if (!scene.beam || !scene.beam->track || !scene.beam->track->slides())
    return {factor * run::step_seconds(scene, method, 0, moving), factorisation};
  return {factor * run::step_seconds(scene, method, 0, sliding_solves * moving) + sliding_factors * factorisation,
          factorisation};
}

/// Of trial runs with the first step.
integrate::StepCount trial_steps(const FirstRun& run) {
  return run.simulation->passage().count_steps(run.simulation->plan().end_time, run.first_step,
                                               error_control::trial_steps_per_sample * run.first_step);
}

void count_single(const FirstRun& run, Cost& cost) {
  const run::Plan& plan = run.simulation->plan();
  const run::Outputs outputs = run::outputs_of({run.scene, run.simulation->system().fleet(), run.bridge()});
  const double samples = plan.end_time / (plan.interval * static_cast<double>(plan.stored)) + 1.0;
  const integrate::StepCount count =
      run.scene.exact_in_time() ? integrate::StepCount{plan.end_time / plan.interval}
                                : run.simulation->passage().count_steps(plan.end_time, plan.time_step, plan.interval);
  cost.steps = count.steps;
  cost.seconds = step_seconds(run).of({refinement(run) * count.steps, count.lengths});
  cost.stored = bytes_per_number * samples * static_cast<double>(outputs.layout().width() + 1);
}

void count_runs(const FirstRun& run, Cost& cost) {
  scene::Scene scene = run.whole;
  scene.beam = run.scene.beam;
  if (!scene.exact_in_time()) scene.model.step = run.simulation->plan().time_step;
  // the usual choice of trial runs
  if (scene.model.vehicles == scene::VehicleModel::automatic) scene.model.vehicles = scene::VehicleModel::linear;
  std::vector<std::string> ignored;
  const ensemble::CaseRunner runner(scene, ignored);
  const double sweep_runs = static_cast<double>(runner.speeds().size() * runner.trains());
  cost.seconds = refinement(run) * runner.cost_of_all() * static_cast<double>(run.runs) / sweep_runs;
  if (!scene.exact_in_time()) cost.steps = runner.duration(0, runner.speeds().front()) / *scene.model.step;
  cost.stored =
      bytes_per_peak * static_cast<double>(run.runs * std::max<std::size_t>(1, run.scene.output.probes.size()));
  if (!scene.modes_open) return;
  const double factor = error_control::is_controlled(scene, run::acceleration) ? modes_unfiltered : modes_low_passed;
  if (const std::optional<error_control::QuickerModes> modes = error_control::quicker_modes(scene);
      modes && modes->seconds < cost.seconds)
    cost.faster_way =
        fmt::format("by modes, if these are accurate enough, about {}",
                    results::duration_text(factor * modes->seconds * static_cast<double>(run.runs) / sweep_runs));
}

}  // namespace

Cost cost_of(const FirstRun& run) {
  Cost cost;
  if (const beam::Beam* beam = run.bridge()) cost.unknowns = static_cast<double>(beam->columns()) * beam->block();
  if (run.simulation) cost.unknowns += run.simulation->system().freedom();
  cost.memory = program_bytes + scene::memory_of(run.scene);
  if (run.scene.analysis != options::Analysis::transient) return cost;
  run.whole.sweep ? count_runs(run, cost) : count_single(run, cost);
  if (!run.has_trial_runs || run.scene.exact_in_time()) return cost;
  const integrate::StepCount trial = trial_steps(run);
  cost.trial_seconds =
      step_seconds(run).of({equivalent_runs * refinement(run) * trial.steps, equivalent_runs * trial.lengths});
  return cost;
}

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", std::ceil(1e-3 * bytes));
  if (bytes < 1e9) return fmt::format("{:.3g} MB", 1e-6 * bytes);
  return fmt::format("{:.3g} GB", 1e-9 * bytes);
}

}  // namespace traverse::check
