// Brings a run to its initial state: creates its Passage with the static equilibrium, or reads the state of a
// checkpoint if the run continues an earlier one, and checks whether low-pass filters can be applied.
#include "ready_run.hpp"

#include <fmt/format.h>

#include <string>

#include "prepare.hpp"
#include "run/deck_acceleration.hpp"
#include "run/process.hpp"
#include "run/wheel_unloading.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr double rounding_worth_a_note = 1e-9;  // relative error of static deflections

std::optional<Plan> plan_of(const results::Checkpoint* earlier) {
  if (earlier == nullptr) return std::nullopt;
  return Plan{0.0, earlier->time_step, earlier->interval, earlier->stored};
}

}  // namespace

ReadyRun::ReadyRun(Job& given)
    : job(given),
      scene(given.scene),
      accuracy(given.accuracy),
      counting(prepare(scene, accuracy, given.beam, given.notes)),
      earlier(plan_of(given.earlier)),
      passage(scene, given.beam, given.notes, earlier ? &*earlier : nullptr),
      wheels(wheels_at_start(scene).size()) {
  MPI_Comm_rank(job.comm, &rank);
  if (earlier && scene.model.step && earlier->time_step < *scene.model.step) accuracy.reject_all();
  if (goes_on() && !(passage.plan().end_time > job.earlier->time))
    throw InputError(fmt::format("restart: the run has come to {:g} s already, its end is at {:g} s", job.earlier->time,
                                 passage.plan().end_time));
  for (const std::string& note : options::notes_on_unused(options::in_force())) job.notes.push_back(note);
  passage.start(job.notes);
  record_rounding();
  choose_filters();
  if (goes_on()) {
    archive.emplace(job.comm, job.earlier->of_ranks);
    passage.keep(*archive);
    if (passage.stopped_at_limit())
      throw InputError(
          fmt::format("restart: the run has taken {} steps already, which is the limit of ts_max_steps; "
                      "raise it or leave it out",
                      passage.steps()));
    job.notes.push_back(fmt::format("goes on from t = {:g} s", job.earlier->time));
  }
  print_notes(job.comm, scene, job.notes);
}

void ReadyRun::record_rounding() {
  const double error = passage.system().static_error();
  if (error > rounding_worth_a_note)
    job.notes.push_back(
        fmt::format("static deflections: relative error about {:.1g}, by rounding in the many elements "
                    "between supports",
                    error));
}

void ReadyRun::choose_filters() {
  if (counting > 0.0) {
    const std::string trouble = filter_obstacle(counting, passage.plan(), scene.output.probes.size());
    filters_deck = trouble.empty();
    if (!filters_deck) accuracy.estimates[low_passed].accepted = false;
    if (!filters_deck) job.notes.push_back("deck accelerations are not low-passed: " + trouble);
  }
  if (filters_wheels(scene)) {
    const std::string trouble = filter_obstacle(scene.output.wheel_low_pass, passage.plan(), wheels, "wheels");
    filters_forces = trouble.empty();
    if (!filters_forces) job.notes.push_back("wheel forces are not low-passed: " + trouble);
  }
}

}  // namespace traverse::app
