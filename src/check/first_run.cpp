// Assembles beam, modes and coupled system (Passage) of the first run of a scene or study, with the first mesh and step
// of the trial runs, and computes the first natural frequencies.
#include "first_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "error_control/accuracy.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/modes_for_damping.hpp"
#include "error_control/multibody_step_search.hpp"
#include "error_control/sweep_model.hpp"
#include "error_control/trial_runs.hpp"
#include "run/deck_acceleration.hpp"
#include "scene_at_rest.hpp"
#include "study/study_scenes.hpp"
#include "traverse/options/input.hpp"

namespace traverse::check {
namespace {

/// Checks all input of a study.
scene::Scene checked_scene(const scene::Scene& given) {
  if (!given.study) return given;
  const study::StudyScenes scenes(given);
  for (const std::size_t base : scenes.extreme_bases()) (void)scenes.base(base);
  return scenes.base(0);
}

std::size_t runs_of(const scene::Scene& given) {
  if (given.study) return given.study->runs();
  if (!given.sweep) return 1;
  return std::max<std::size_t>(1, given.sweep->speeds.size()) * std::max<std::size_t>(1, given.sweep->loads.size());
}

}  // namespace

FirstRun::FirstRun(const scene::Scene& given)
    : whole(checked_scene(given)), scene(first_run(whole)), runs(runs_of(given)) {
  if (error_control::takes_modes_for_damping(scene)) {
    whole = error_control::with(whole, error_control::modes_for_damping(PETSC_COMM_SELF, scene, notes).model);
    scene = first_run(whole);
  }
  has_trial_runs = error_control::chooses(scene) && error_control::adaptive_step_option(scene) == nullptr;
  if (has_trial_runs) error_control::set_first_mesh(scene);
  shared = std::make_unique<run::SharedBeam>(PETSC_COMM_SELF, scene, notes);
  const bool has_motion = scene.analysis != options::Analysis::modes;
  if (shared->beam)
    shared->damp(scene, has_trial_runs || scene.model.modes > 0 || (has_motion && !scene.model.step), notes);
  if (has_motion) shared->prepare(scene, notes);
  if (has_motion) choose_mesh_and_step();
  if (has_motion) {
    simulation = std::make_unique<run::Simulation>(scene, *shared, run::Wants(), notes);
  }
  for (const std::string& note : options::notes_on_unused(*scene.given)) notes.push_back(note);
  notes.insert(notes.end(), whole.notes.begin(), whole.notes.end());
  if (shared->beam) find_frequencies();
}

void FirstRun::choose_mesh_and_step() {
  if (scene.analysis != options::Analysis::transient) return;
  if (error_control::chooses_multibody_step(scene) && error_control::adaptive_step_option(scene) == nullptr) {
    scene.model.step = error_control::first_multibody_step(scene);
    choice.push_back(fmt::format(
        "initial steps of {:.3g} s; runs of the whole scene halve them until the errors of positions and forces "
        "are within accuracy {:g}",
        *scene.model.step, scene.accuracy));
    return;
  }
  if (!has_trial_runs) {
    if (scene.model.step) choice.push_back(fmt::format("steps of {:g} s, as given", *scene.model.step));
    if (const options::Entry* option = error_control::adaptive_step_option(scene);
        option != nullptr && error_control::chooses(scene))
      choice.push_back(fmt::format("no trial runs for accuracy {:g}: {}", scene.accuracy, option->given()));
    return;
  }
  std::vector<std::string> ignored;
  const double end = run::Passage(scene, *shared, ignored).plan().end_time;
  const error_control::FirstSteps steps =
      error_control::first_steps(scene, shared->omega ? shared->omega->first : 0.0, end);
  const std::string mesh = scene.by_given_modes() ? "given modes"
                                                  : fmt::format("{} elements a {}", error_control::mesh_of(scene),
                                                                scene.beam->track ? "sleeper bay" : "span");
  choice.push_back(fmt::format("{}; {}",
                               scene.by_given_modes() ? mesh
                               : scene.mesh_open      ? mesh + ", refined by trial runs"
                                                      : mesh + ", as given",
                               scene.model.step
                                   ? fmt::format("steps of {:g} s, as given", *scene.model.step)
                                   : fmt::format("initial steps of {:.3g} s: {}", steps.first, steps.why)));
  choice.push_back(fmt::format(
      "trial runs begin with longer steps and elements, and refine them until the errors of the peaks are within "
      "accuracy {:g}",
      scene.accuracy));
  first_step = scene.model.step.value_or(steps.first);
  longest_step = scene.model.step.value_or(steps.longest);
  scene.model.step = first_step;
  scene.model.step_probes = scene.model.local_compliance = true;  // as the chosen model
}

void FirstRun::find_frequencies() { frequencies = run::first_frequencies(*shared); }

}  // namespace traverse::check
