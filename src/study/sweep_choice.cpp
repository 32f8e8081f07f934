#include "sweep_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "accuracy/accuracy.hpp"
#include "accuracy/trials.hpp"
#include "lanes_choice.hpp"
#include "modes_choice.hpp"
#include "run/deck_acceleration.hpp"

namespace traverse::app {
namespace {

/// What is promised of all runs is what both promise, with the larger error.
void add(const Accuracy& one, std::optional<Accuracy>& all) {
  if (!all) {
    all = one;
    return;
  }
  for (std::size_t q = 0; q < quantities; ++q) {
    all->promises[q].kept &= one.promises[q].kept;
    all->promises[q].expected = std::max(all->promises[q].expected, one.promises[q].expected);
  }
}

void say(const Scene& scene, const Accuracy& all, std::vector<std::string>& notes) {
  const std::string mesh = scene.by_given_modes() ? "given modes"
                                                  : fmt::format("{} elements a {}", mesh_of(scene),
                                                                scene.beam->track ? "sleeper bay" : "span");
  notes.push_back(fmt::format("all runs: {}, steps of {:g} s", mesh, *scene.time_step));
  if (scene.vehicle_model == VehicleModel::linear && !scene.vehicles.empty())
    notes.emplace_back("vehicles are taken as linear; a run in which that shows is repeated with the mechanisms");
  std::string expected;
  for (const auto& [quantity, error] : all.expected())
    expected += fmt::format("{}{} {:.1g}", expected.empty() ? "" : ", ", quantity, error);
  std::replace(expected.begin(), expected.end(), '_', ' ');
  notes.push_back("expected errors of the peaks of all runs: " + (expected.empty() ? "none promised" : expected));
}

/// The finest of what some speeds need; nothing where no accuracy was to be chosen by.
std::optional<Accuracy> choose_at_speeds(const Scene& given, Scene& scene, std::vector<std::string>& notes) {
  std::vector<double> speeds = given.sweep->speeds;
  if (speeds.empty()) speeds = {given.vehicles.empty() ? given.load.speed : given.train.speed};
  std::optional<Accuracy> all;
  for (const double speed : std::set{speeds.front(), speeds[speeds.size() / 2], speeds.back()}) {
    Scene one = at_speed(given, speed);
    std::vector<std::string> own;
    const Accuracy accuracy = choose(PETSC_COMM_SELF, one, own);
    if (!accuracy.measured) return std::nullopt;
    notes.push_back(fmt::format("at {:g} m/s:", speed));
    notes.insert(notes.end(), own.begin(), own.end());
    const int mesh = all ? std::max(mesh_of(scene), mesh_of(one)) : mesh_of(one);
    if (!all || *one.time_step < *scene.time_step) scene.time_step = one.time_step;
    set_mesh(scene, mesh);
    scene.rest_tolerance = one.rest_tolerance;
    scene.step_probes = one.step_probes;
    scene.contact_seats = one.contact_seats;
    if (!all || one.vehicle_model == VehicleModel::full) scene.vehicle_model = one.vehicle_model;
    scene.most_defect = one.most_defect;
    if (accuracy.seen_until != Accuracy::the_end)
      scene.sweep->trials_reach = std::min(scene.sweep->trials_reach, accuracy.seen_until * speed);
    scene.sweep->trials_lost_contact |= accuracy.lost_contact;
    add(accuracy, all);
  }
  return all;
}

/// What trials of a sweep judge by. Low-passed accelerations only where no run has its peak within the unsettled end:
/// it goes on until the last wheel has left and the filter has settled behind it, and the bridge does not ring on.
Scene judged(const Scene& given, std::vector<std::string>& notes) {
  Scene scene = given;
  if (!chooses(at_speed(given, 1.0))) return scene;  // nothing is tried, whatever the speed
  std::vector<std::string> ignored;                  // the runs say so themselves
  settle_low_pass(PETSC_COMM_SELF, scene, ignored);
  if (!asks_for(scene, low_passed)) return scene;
  const double end = unsettled_end(*scene.output.low_pass);
  if (damps_all_modes(scene) && !scene.end_time && scene.tail.value_or(0.0) >= end) return scene;
  std::vector<std::string> others;
  for (std::size_t q = 0; q < low_passed; ++q)
    if (asks_for(scene, q) || (q == acceleration && scene.accuracy_of.empty())) others.emplace_back(stored_names[q]);
  const Promise promise{
      true, false, 0.0,
      fmt::format("in sweeps and studies it takes a bridge with damping and scene_tail {:.3g} or more, "
                  "until the filter has settled behind the train",
                  end)};
  const std::string note = not_promised(low_passed, promise);
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  if (!others.empty()) scene.accuracy_of = others;
  if (others.empty()) scene.output.low_pass = 0.0;
  return scene;
}

results::Sweep::Model model_of(const Scene& scene) {
  results::Sweep::Model model;
  model.modes = scene.model_modes;
  model.elements = mesh_of(scene);
  model.in_bays = scene.beam->track.has_value();
  if (scene.sweep) model.method = scene.sweep->method;
  if (!scene.exact_in_time()) model.time_step = scene.time_step.value_or(0.0);
  return model;
}

}  // namespace

Scene at_speed(const Scene& sweep, double speed) {
  Scene scene = sweep;
  if (!sweep.sweep->loads.empty()) scene.load = sweep.sweep->loads.front();
  if (scene.train.courses.empty()) scene.train.speed = scene.vehicles.empty() ? 0.0 : speed;
  if (scene.load.courses.empty()) scene.load.speed = scene.load.forces.empty() ? 0.0 : speed;
  return scene;
}

std::optional<SweepChoice> choose_side_by_side(const Scene& given, std::vector<std::string>& notes) {
  if (given.vehicles.empty()) return {};
  std::optional<LanesChoice> lanes = lanes_that_do(judged(given, notes), notes);
  if (!lanes) return {};
  lanes->scene.output.low_pass = given.output.low_pass;
  lanes->scene.accuracy_of = given.accuracy_of;
  SweepChoice choice{std::move(lanes->scene), {}};
  choice.model = model_of(choice.scene);
  choice.model.accuracy = given.accuracy;
  for (std::size_t q = 0; q < quantities; ++q)
    if (lanes->promises[q].kept)
      choice.model.expected_errors.emplace_back(stored_names[q], lanes->promises[q].expected);
  return choice;
}

SweepChoice choose_for_sweep(const Scene& given, std::vector<std::string>& notes) {
  if (std::optional<SweepChoice> lanes = choose_side_by_side(given, notes)) return *lanes;
  return choose_one_by_one(given, notes);
}

SweepChoice choose_one_by_one(const Scene& given, std::vector<std::string>& notes) {
  const Scene by = judged(given, notes);
  SweepChoice choice{given, {}};
  const std::optional<Accuracy> all = choose_at_speeds(by, choice.scene, notes);
  if (!all && given.model_modes > 0 && !given.by_given_modes())
    notes.push_back(fmt::format(
        "no errors of the peaks are promised: model_modes = {} is given, and no trial runs show what it leaves out",
        given.model_modes));
  if (!all) return {given, model_of(given)};
  say(choice.scene, *all, notes);
  Scene tried = choice.scene;
  tried.accuracy_of = by.accuracy_of;
  tried.output.low_pass = by.output.low_pass;
  const ModesChoice modes =
      given.by_given_modes() ? ModesChoice{given.model_modes, 0.0} : modes_that_do(tried, *all, notes);
  choice.scene.model_modes = modes.modes;
  choice.model = model_of(choice.scene);
  choice.model.accuracy = given.accuracy;
  choice.model.expected_errors = all->expected();
  for (auto& [quantity, error] : choice.model.expected_errors) error += modes.error;
  return choice;
}

}  // namespace traverse::app
