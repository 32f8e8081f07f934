// Estimates run time, memory and file size: the number of steps times the measured time of a step, with factors for the
// trial runs.
#include "cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/one_step_methods.hpp"
#include "ensemble/case_runner.hpp"
#include "error_control/accuracy.hpp"
#include "error_control/mode_choice.hpp"
#include "results/terminal.hpp"
#include "run/outputs.hpp"
#include "run/rank_choice.hpp"
#include "run/step_cost.hpp"
#include "scene/limits.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

// As measured; benchmarks/check_estimates.py has how near estimates come.
constexpr double program = 6.5e7;      // bytes, of the program with its libraries
constexpr double moving_spans = 24.0;  // of a bridge whose other spans rest
constexpr double of_petsc = 2.0;       // times the time of the program's own integrators
constexpr double trial_runs = 8.0;     // with steps of the first length, that take as long as all trial runs
// Times the modes that EN 1990 counts: those that runs take where accelerations are low-passed, and where they are not.
constexpr double modes_low_passed = 4.0, modes_of_all = 10.0;
constexpr double bytes_a_number = 8.0;
constexpr double bytes_a_peak = 200.0;  // of a run of a sweep, each probe

/// Below this accuracy trial runs refine mesh and step further than where they begin.
constexpr double begins_well = 1e-3;
double refinement(const Look& look) {
  return look.tried ? std::max(1.0, std::sqrt(begins_well / look.scene.accuracy)) : 1.0;
}

double step_seconds(const Look& look) {
  const Scene& scene = look.scene;
  if (scene.exact_in_time())
    return modal_instant_seconds(scene, static_cast<double>(look.shared->modal->modes()),
                                 look.shared->modal->dampers_couple());
  const options::Entry* asked = options::in_force().find("ts_type");
  const std::string method = asked == nullptr ? scene.model.method : asked->value;
  const bool by_petsc = asked != nullptr && structure::find_method(method) == nullptr;
  const double moving = scene.beam && !stage_work(scene).cut
                            ? std::min(1.0, moving_spans / static_cast<double>(scene.beam->spans.size()))
                            : 1.0;
  return (by_petsc ? of_petsc : 1.0) * step_seconds(scene, method, 0, moving);
}

void count_single(const Look& look, Cost& cost) {
  const Plan& plan = look.passage->plan();
  const Outputs outputs = outputs_of({look.scene, look.passage->system().fleet(), look.bridge()});
  const double samples = plan.end_time / (plan.interval * static_cast<double>(plan.stored)) + 1.0;
  cost.steps = plan.end_time / plan.time_step;
  cost.seconds = cost.steps * step_seconds(look);
  cost.stored = bytes_a_number * samples * static_cast<double>(outputs.layout().width() + 1);
}

void count_runs(const Look& look, Cost& cost) {
  Scene scene = look.whole;
  scene.beam = look.scene.beam;
  if (!scene.exact_in_time()) scene.model.step = look.passage->plan().time_step;
  // As trial runs mostly find.
  if (scene.model.vehicles == VehicleModel::automatic) scene.model.vehicles = VehicleModel::linear;
  std::vector<std::string> ignored;
  const CaseRunner runner(scene, ignored);
  const double of_sweep = static_cast<double>(runner.speeds().size() * runner.trains());
  cost.seconds = runner.cost_of_all() * static_cast<double>(look.runs) / of_sweep;
  if (!scene.exact_in_time()) cost.steps = runner.duration(0, runner.speeds().front()) / *scene.model.step;
  cost.stored =
      bytes_a_peak * static_cast<double>(look.runs * std::max<std::size_t>(1, look.scene.output.probes.size()));
  if (!scene.modes_open) return;
  const double more = asks_for(scene, acceleration) ? modes_of_all : modes_low_passed;
  if (const std::optional<QuickerModes> modes = quicker_modes(scene); modes && modes->seconds < cost.seconds)
    cost.quicker =
        fmt::format("by modes, where these do as well, about {}",
                    results::duration_text(more * modes->seconds * static_cast<double>(look.runs) / of_sweep));
}

}  // namespace

Cost cost_of(const Look& look) {
  Cost cost;
  if (const beam::Beam* beam = look.bridge()) cost.unknowns = static_cast<double>(beam->columns()) * beam->block();
  if (look.passage) cost.unknowns += look.passage->system().freedom();
  cost.memory = program + memory_of(look.scene);
  if (look.scene.analysis != Analysis::transient) return cost;
  look.whole.sweep ? count_runs(look, cost) : count_single(look, cost);
  cost.seconds *= refinement(look);
  if (look.tried && !look.scene.exact_in_time())
    cost.trials = refinement(look) * trial_runs * look.horizon / look.first_step * step_seconds(look);
  return cost;
}

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", std::ceil(1e-3 * bytes));
  if (bytes < 1e9) return fmt::format("{:.3g} MB", 1e-6 * bytes);
  return fmt::format("{:.3g} GB", 1e-9 * bytes);
}

}  // namespace traverse::app
