// Advances a run to a requested time in whole sample intervals, and checks the forces that the calling program applies
// to bodies and to the beam.
#include "step_by_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "error_control/sweep_model.hpp"
#include "run/process.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr double same_sample = 1e-6;  // relative to the interval: times closer than this are the same sample

void check_goes_in_time(const scene::Scene& scene) {
  const char* other = scene.study                                      ? "a study"
                      : scene.fit                                      ? "a fit"
                      : scene.sweep                                    ? "a sweep"
                      : scene.analysis != options::Analysis::transient ? "scene_analysis"
                                                                       : nullptr;
  for (const char* option : {"-describe", "-restart", "-help", "-version"})
    if (scene.find_option(option + 1) != nullptr) other = option;
  if (other != nullptr) throw InputError(fmt::format("a problem is one run in time; remove {}", other));
}

}  // namespace

ChosenScene choose_for_one_run(scene::Scene scene) {
  check_goes_in_time(scene);
  scene.quiet = true;
  std::vector<std::string> ignored;
  error_control::Accuracy accuracy = choose_model(PETSC_COMM_SELF, scene, ignored);
  return {std::move(scene), std::move(accuracy)};
}

StepByStep::StepByStep(ChosenScene chosen) : scene_(std::move(chosen.scene)), shared_(PETSC_COMM_SELF, scene_, notes_) {
  const double cutoff = prepare(scene_, chosen.accuracy, shared_, notes_);
  simulation_.emplace(
      scene_, shared_,
      run::Wants{.stored = true, .limits = scene_.has_run_limits(), .wheel_filter = true, .deck_cutoff = cutoff},
      notes_);
  outputs_.emplace(run::outputs_of({scene_, simulation_->system().fleet(), shared_.bridge()}));
  if (shared_.beam) shared_.beam->release_matrices();
  simulation_->begin({this});
}

void StepByStep::sample(const integrate::Instant& instant) {
  if (!is_stored(instant.purpose)) return;
  time_ = instant.time;
  outputs_->fill(simulation_->evaluation().observed(), values_);
}

bool StepByStep::step(double t, long /*steps*/) {
  return t < wanted_ - same_sample * interval() && run::caught_signal() == 0;
}

double StepByStep::interval() const {
  return simulation_->plan().interval * static_cast<double>(simulation_->plan().stored);
}

void StepByStep::advance(double t) {
  if (failed_) throw SolverError("the passage has failed before and goes no further");
  const double slack = same_sample * interval();
  if (!(t <= end() + slack))
    throw InputError(fmt::format("{:g} s is beyond the end of the scene, {:g} s (ts_max_time)", t, end()));
  wanted_ = std::min(std::ceil(t / interval() - same_sample) * interval(), end());
  if (wanted_ <= time_ + slack) return;
  failed_ = true;
  simulation_->run({this});
  if (run::caught_signal() != 0) throw Error("the run was stopped", 128 + run::caught_signal());
  if (time_ < wanted_ - slack)
    throw SolverError(fmt::format("the run ended at {:g} s, at the limit of ts_max_steps", time_));
  failed_ = false;
}

std::span<const double> StepByStep::read(const std::string& dataset) const {
  std::size_t first = 0;
  for (const auto& field : layout().fields) {
    if (field.name == dataset) return std::span(values_).subspan(first, field.width());
    first += field.width();
  }
  for (const auto& constant : layout().constants)
    if (constant.name == dataset) return constant.values;
  throw InputError("there is no quantity " + dataset + "; traverse_describe lists the available quantities");
}

traverse::Result StepByStep::result() {
  const double residual = simulation_->system().linearisation_residual();
  if (residual <= scene_.model.residual_limit) simulation_->evaluation().check_balance();
  const run::Result found = simulation_->result();
  const base::PassagePeaks peaks = found.passage_peaks();
  const std::vector<double> statics = simulation_->static_deflections();
  const auto extreme = [](const base::Extreme& one) { return traverse::Extreme{one.value, one.time}; };
  traverse::Result result;
  for (std::size_t p = 0; p < peaks.peaks.size(); ++p)
    result.probes.push_back({scene_.output.probes[p], extreme(peaks.peaks[p].deflection),
                             extreme(peaks.peaks[p].acceleration), extreme(peaks.peaks[p].moment), statics[p]});
  if (!simulation_->system().fleet().wheels.empty()) {
    result.least_wheel_force = peaks.least_wheel_force;
    result.greatest_wheel_force = peaks.greatest_wheel_force;
    result.contact_losses = peaks.contact_losses;
    result.longest_loss = peaks.longest_loss;
  }
  std::vector<options::VerdictLimit> limits;
  for (const results::Verdict& verdict : found.verdicts) limits.push_back(verdict.limit);
  const std::vector<std::string> names = results::names_of_limits(limits);
  for (std::size_t l = 0; l < limits.size(); ++l) {
    const results::EvaluatedQuantity& value = found.verdicts[l].found;
    result.limits.push_back(
        {names[l], limits[l].quantity, found.verdicts[l].unit, limits[l].value, value.value, value.x, value.why});
  }
  const double scale = found.summary.energy_scale;
  result.energy_residual = scale > 0.0 ? found.summary.energy_residual / scale : 0.0;
  result.linearisation_residual = residual;
  result.steps = static_cast<double>(found.summary.steps);
  result.model = scene_.beam ? results::method_of(error_control::stored_model(scene_, {})) : "";
  return result;
}

void StepByStep::check_takes_forces() {
  if (simulation_->passage().exact_in_time())
    throw InputError("forces cannot be set where modes move exactly in time: model_modes 0");
}

void StepByStep::set_body_force(int vehicle, const std::string& body, const std::array<double, 3>& force) {
  check_takes_forces();
  const std::vector<train::Member>& members = simulation_->system().fleet().members;
  if (vehicle < 0 || vehicle >= static_cast<int>(members.size()))
    throw InputError(
        fmt::format("there is no vehicle {}: they count from 0, and there are {}", vehicle, members.size()));
  const train::Vehicle& type = *members[static_cast<std::size_t>(vehicle)].type;
  const auto& bodies = type.mechanism.bodies;
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const auto& b) { return b.name == body; });
  if (found == bodies.end()) throw InputError(fmt::format("vehicle {} ({}) has no body {}", vehicle, type.name, body));
  const Eigen::Vector3d action(force[0], force[1], force[2]);
  if (!action.allFinite()) throw InputError("a force has to be a finite number");
  simulation_->system().apply_to_body(vehicle, static_cast<int>(found - bodies.begin()), action);
}

void StepByStep::set_beam_force(double x, double force) {
  check_takes_forces();
  if (!std::isfinite(force)) throw InputError("a force has to be a finite number");
  simulation_->system().apply_to_beam(x, force);
}

}  // namespace traverse::app
