// Computes trial runs at the lowest, the middle and the highest speed, and uses the finest mesh and step for all runs;
// also decides whether low-passed accelerations can have an error estimate.
#include "error_control/sweep_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include "error_control/accuracy.hpp"
#include "error_control/batch_model.hpp"
#include "error_control/mode_search.hpp"
#include "error_control/modes_for_damping.hpp"
#include "error_control/trial_runs.hpp"
#include "run/deck_acceleration.hpp"

namespace traverse::error_control {

using scene::Scene;

namespace {

void describe(const Scene& scene, const Accuracy& all, std::vector<std::string>& notes) {
  const std::string mesh = scene.by_given_modes() ? "given modes"
                                                  : fmt::format("{} elements a {}", mesh_of(scene),
                                                                scene.beam->track ? "sleeper bay" : "span");
  notes.push_back(fmt::format("all runs: {}, steps of {:.3g} s", mesh, *scene.model.step));
  if (scene.model.vehicles == scene::VehicleModel::linear && !scene.vehicles.empty())
    notes.emplace_back(
        "vehicles are linearised; a run whose residual exceeds its limit is repeated with the mechanisms");
  std::string expected;
  for (const auto& [quantity, error] : all.expected())
    expected += fmt::format("{}{} {:.1g}", expected.empty() ? "" : ", ", quantity, error);
  std::replace(expected.begin(), expected.end(), '_', ' ');
  notes.push_back("estimated errors of the peaks of all runs: " + (expected.empty() ? "none" : expected));
}

/// The finest model of three speeds; empty if mesh and step are not open.
std::optional<Choice> choose_at_speeds(const Scene& given, std::vector<std::string>& notes) {
  std::vector<double> speeds = given.sweep->speeds;
  if (speeds.empty()) speeds = {scene::moving_speed(given)};
  std::optional<Choice> all;
  for (const double speed : std::set{speeds.front(), speeds[speeds.size() / 2], speeds.back()}) {
    std::vector<std::string> own;
    Choice one = choose(PETSC_COMM_SELF, at_speed(given, speed), own);
    if (!one.accuracy.measured) return std::nullopt;
    notes.push_back(fmt::format("at {:g} m/s:", speed));
    notes.insert(notes.end(), own.begin(), own.end());
    one.model.trials_lost_contact = one.accuracy.lost_contact;
    if (all) one.accuracy.merge(all->accuracy);
    all = Choice{all ? finer(all->model, one.model) : one.model, one.accuracy, {}, {}};
  }
  return all;
}

/// The scene for the trial runs of a sweep. Low-passed accelerations are controlled only if no run can have its peak
/// within the unsettled end: it continues until the last wheel has left and the filter has settled after that, and the
/// bridge's vibration is damped.
Scene trial_scene(const Scene& given, std::vector<std::string>& notes) {
  Scene scene = given;
  if (!chooses(at_speed(given, 1.0))) return scene;  // no trial runs at any speed
  std::vector<std::string> ignored;                  // the runs report these notes themselves
  set_low_pass(PETSC_COMM_SELF, scene, ignored);
  if (!is_controlled(scene, run::low_passed)) return scene;
  const double end = run::unsettled_end(*scene.output.low_pass);
  if (damps_all_modes(scene) && !scene.end_time && scene.tail.value_or(0.0) >= end) return scene;
  std::vector<std::string> others;
  for (std::size_t q = 0; q < run::low_passed; ++q)
    if (is_controlled(scene, q) || (q == run::acceleration && scene.accuracy_of.empty()))
      others.emplace_back(run::stored_names[q]);
  const ErrorEstimate estimate{
      true, false, 0.0,
      fmt::format("in sweeps and studies it requires a bridge with damping and a scene_tail of at least {:.3g}, "
                  "so that the filter settles after the train",
                  end)};
  const std::string note = not_estimated(run::low_passed, estimate);
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  if (!others.empty()) scene.accuracy_of = others;
  if (others.empty()) scene.output.low_pass = 0.0;
  return scene;
}

}  // namespace

Scene at_speed(const Scene& sweep, double speed) {
  Scene scene = sweep;
  if (!sweep.sweep->loads.empty()) {
    scene.load = sweep.sweep->loads.front();
    scene.load.speed = sweep.load.speed;
  }
  scene::set_speed(scene, speed);
  return scene;
}

std::optional<Choice> choose_batched(const Scene& given, std::vector<std::string>& notes) {
  if (given.vehicles.empty() || takes_modes_for_damping(given)) return {};
  return choose_batch_model(trial_scene(given, notes), notes);
}

Choice choose_unbatched(const Scene& given, std::vector<std::string>& notes) {
  if (takes_modes_for_damping(given)) {
    Choice by_modes = modes_for_damping(PETSC_COMM_SELF, given, notes);
    if (by_modes.model.modes > 0) return by_modes;
  }
  const Scene scene_of_trials = trial_scene(given, notes);
  const auto keeps_acceleration = [&](const Choice& choice) {
    return choice.accuracy.estimates[run::acceleration].accepted ||
           !is_controlled(scene_of_trials, run::acceleration) || !damps_high_modes(scene_of_trials);
  };
  std::vector<std::string> of_modes, of_elements;
  const std::optional<Choice> by_modes = choose_modes(scene_of_trials, of_modes);
  std::optional<Choice> all;
  if (!by_modes || !keeps_acceleration(*by_modes)) all = choose_at_speeds(scene_of_trials, of_elements);
  const bool takes_modes = by_modes && (!all || !keeps_acceleration(*all));
  std::ranges::move(takes_modes ? of_modes : of_elements, std::back_inserter(notes));
  if (takes_modes) return *by_modes;
  if (!all && given.model.modes > 0 && !given.by_given_modes())
    notes.push_back(fmt::format(
        "errors are not estimated: model_modes = {} is given, and trial runs do not determine the truncation error",
        given.model.modes));
  if (!all) return {given.model, {}, {}, {}};
  describe(with(scene_of_trials, all->model), all->accuracy, notes);
  return *all;
}

results::RunModel stored_model(const Scene& scene, const Accuracy& accuracy) {
  results::RunModel model;
  model.modes = scene.model.modes;
  model.elements = mesh_of(scene);
  model.in_bays = scene.beam->track.has_value();
  model.method = scene.model.method;
  if (!scene.exact_in_time()) model.time_step = scene.model.step.value_or(0.0);
  if (accuracy.measured) model.accuracy = scene.accuracy;
  model.expected_errors = accuracy.expected();
  return model;
}

}  // namespace traverse::error_control
