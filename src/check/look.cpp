// Assembles beam, modes and passage of the first run of a scene or study, with the mesh and step that trial runs would
// begin with, and computes the first natural frequencies.
#include "look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "error_control/accuracy.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/multibody_step_search.hpp"
#include "error_control/sweep_model.hpp"
#include "error_control/trial_runs.hpp"
#include "error_control/trial_window.hpp"
#include "modes/modes.hpp"
#include "study/study_scenes.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr double some_step = 1e-6;  // s, to look at a scene before it has a step
constexpr std::size_t told_frequencies = 3;

Scene first_scene(const Scene& given) {
  if (!given.study) return given;
  const StudyScenes scenes(given);
  for (const std::size_t base : scenes.extreme_bases()) (void)scenes.base(base);  // all input is checked
  return scenes.base(0);
}

Scene one_run(const Scene& whole) {
  if (!whole.sweep) return whole;
  const std::vector<double>& speeds = whole.sweep->speeds;
  return at_speed(whole, !speeds.empty()          ? speeds.front()
                         : whole.vehicles.empty() ? whole.load.speed
                                                  : whole.train.speed);
}

std::size_t runs_of(const Scene& given) {
  if (given.study) return given.study->runs();
  if (!given.sweep) return 1;
  return std::max<std::size_t>(1, given.sweep->speeds.size()) * std::max<std::size_t>(1, given.sweep->loads.size());
}

}  // namespace

Look::Look(const Scene& given) : whole(first_scene(given)), scene(one_run(whole)), runs(runs_of(given)) {
  tried = chooses(scene) && own_measure() == nullptr;
  if (tried) set_first_mesh(scene);
  shared = std::make_unique<SharedBeam>(PETSC_COMM_SELF, scene, notes);
  const bool moves = scene.analysis != Analysis::modes;
  if (shared->beam) shared->damp(scene, tried || scene.model.modes > 0 || (moves && !scene.model.step), notes);
  if (moves) shared->prepare(scene, notes);
  if (moves) choose_mesh_and_step();
  if (moves) {
    passage = std::make_unique<Passage>(scene, *shared, notes);
    passage->start(notes);
  }
  for (const std::string& note : options::notes_on_unused(options::in_force())) notes.push_back(note);
  notes.insert(notes.end(), whole.notes.begin(), whole.notes.end());
  if (shared->beam) find_frequencies();
}

void Look::choose_mesh_and_step() {
  if (scene.analysis != Analysis::transient) return;
  if (chooses_step_alone(scene) && own_measure() == nullptr) {
    scene.model.step = longest_step_alone(scene);
    choice.push_back(
        fmt::format("steps of {:.3g} s to begin with; runs of the whole scene halve them until positions and "
                    "forces are right to accuracy {:g}",
                    *scene.model.step, scene.accuracy));
    return;
  }
  if (!tried) {
    if (scene.model.step) choice.push_back(fmt::format("steps of {:g} s, as given", *scene.model.step));
    if (const options::Entry* option = own_measure(); option != nullptr && chooses(scene))
      choice.push_back(fmt::format("no trial runs for accuracy {:g}: {}", scene.accuracy, option->given()));
    return;
  }
  Scene timed = scene;
  if (!timed.model.step) timed.model.step = some_step;
  std::vector<std::string> ignored;
  const double end = Passage(timed, *shared, ignored).plan().end_time;
  horizon = initial_window(scene, end);
  const FirstSteps steps = first_steps(scene, shared->omega ? shared->omega->first : 0.0, horizon);
  const std::string mesh = scene.by_given_modes() ? "given modes"
                                                  : fmt::format("{} elements a {}", mesh_of(scene),
                                                                scene.beam->track ? "sleeper bay" : "span");
  choice.push_back(fmt::format("{}; {}",
                               scene.by_given_modes() ? mesh
                               : scene.mesh_open      ? mesh + " to begin with"
                                                      : mesh + ", as given",
                               scene.model.step
                                   ? fmt::format("steps of {:g} s, as given", *scene.model.step)
                                   : fmt::format("steps of {:.3g} s to begin with: {}", steps.first, steps.why)));
  choice.push_back(
      fmt::format("trial runs of the first {:.3g} s refine or coarsen them until the peaks are right to accuracy {:g}",
                  horizon, scene.accuracy));
  first_step = scene.model.step.value_or(steps.first);
  longest_step = scene.model.step.value_or(steps.longest);
  scene.model.step = first_step;
}

void Look::find_frequencies() {
  const beam::Beam& beam = *shared->beam;
  if (beam.model().given) {
    for (const double one : beam.model().given->omega)
      if (frequencies.size() < told_frequencies) frequencies.push_back(one / (2.0 * std::numbers::pi));
    return;
  }
  const bool plain = beam.rail() == nullptr && !beam.model().nonlinear();
  const std::vector<double> omega =
      plain ? modes::distinct_frequencies(beam, told_frequencies)
            : modes::distinct_frequencies(beam::Beam(PETSC_COMM_SELF, linearised(bridge_alone(beam.model()))),
                                          told_frequencies);
  for (const double one : omega) frequencies.push_back(one / (2.0 * std::numbers::pi));
}

}  // namespace traverse::app
