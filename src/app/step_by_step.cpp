// Advances a run to a requested time in whole sample intervals, and checks the forces that the calling program applies
// to bodies and to the beam.
#include "step_by_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr double same_sample = 1e-6;  // relative to the interval: times closer than this are the same sample

void check_goes_in_time(const Scene& scene) {
  const char* other = scene.study                               ? "a study"
                      : scene.fit                               ? "a fit"
                      : scene.sweep                             ? "a sweep"
                      : scene.check                             ? "-check"
                      : scene.find_option("restart") != nullptr ? "-restart"
                      : scene.analysis != Analysis::transient   ? "scene_analysis"
                                                                : nullptr;
  if (other != nullptr) throw InputError(fmt::format("traverse_open computes one run in time; remove {}", other));
}

}  // namespace

Scene StepByStep::chosen(Scene scene, Accuracy& accuracy, std::vector<std::string>& notes) {
  check_goes_in_time(scene);
  scene.quiet = true;
  accuracy = choose_model(PETSC_COMM_SELF, scene, notes);
  return scene;
}

StepByStep::StepByStep(const Scene& scene)
    : scene_(chosen(scene, accuracy_, notes_)), shared_(PETSC_COMM_SELF, scene_, notes_) {
  prepare(scene_, accuracy_, shared_, notes_);
  simulation_.emplace(scene_, shared_, Wants{.stored = true}, notes_);
  outputs_.emplace(outputs_of({scene_, simulation_->system().fleet(), shared_.bridge()}));
  if (shared_.beam) shared_.beam->release_matrices();
  simulation_->begin({this});
}

void StepByStep::sample(const integrate::Instant& instant) {
  if (!is_stored(instant.purpose)) return;
  time_ = instant.time;
  outputs_->fill(simulation_->evaluation().observed(), values_);
}

bool StepByStep::step(double t, long /*steps*/) { return t < wanted_ - same_sample * interval(); }

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
  if (time_ < wanted_ - slack)
    throw SolverError(fmt::format("the passage ended at {:g} s, at the limit of ts_max_steps", time_));
  failed_ = false;
}

void StepByStep::check_takes_forces() {
  if (simulation_->passage().exact_in_time())
    throw InputError("forces cannot be set where modes move exactly in time: model_modes 0");
}

void StepByStep::apply_to_body(int vehicle, const std::string& body, const Eigen::Vector3d& action) {
  check_takes_forces();
  const std::vector<train::Member>& members = simulation_->system().fleet().members;
  if (vehicle < 0 || vehicle >= static_cast<int>(members.size()))
    throw InputError(
        fmt::format("there is no vehicle {}: they count from 0, and there are {}", vehicle, members.size()));
  const train::Vehicle& type = *members[static_cast<std::size_t>(vehicle)].type;
  const auto& bodies = type.mechanism.bodies;
  const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const auto& b) { return b.name == body; });
  if (found == bodies.end()) throw InputError(fmt::format("vehicle {} ({}) has no body {}", vehicle, type.name, body));
  if (!action.allFinite()) throw InputError("a force has to be a finite number");
  simulation_->system().apply_to_body(vehicle, static_cast<int>(found - bodies.begin()), action);
}

void StepByStep::apply_to_beam(double x, double force) {
  check_takes_forces();
  if (!std::isfinite(force)) throw InputError("a force has to be a finite number");
  simulation_->system().apply_to_beam(x, force);
}

}  // namespace traverse::app
