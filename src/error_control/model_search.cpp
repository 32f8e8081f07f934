// Sets up the search of mesh and step, and states the errors of the quantities.
#include "error_control/model_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "error_control/accuracy.hpp"
#include "error_control/search_constants.hpp"

namespace traverse::error_control {

using run::acceleration;
using run::low_passed;
using run::quantities;
using run::wheel_force;
using scene::Scene;

namespace {

/// The largest number of two digits that does not exceed x.
double two_digits(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return std::floor(x / unit * (1.0 + 1e-9)) * unit;
}

/// The reasons why quantities have no estimate whatever mesh and step are; empty: none.
std::array<std::string, quantities> reasons_against(const Scene& scene, const FirstSteps& steps, bool undamped) {
  std::array<std::string, quantities> why;
  for (std::size_t q = 0; q < quantities; ++q)
    if (!is_controlled(scene, q)) why[q] = why_not_controlled(scene, q);
  const double step = scene.model.step.value_or(steps.first);
  if (why[wheel_force].empty() && !resolves_contacts(scene, step))
    why[wheel_force] = fmt::format("the contact vibrates at {:.3g} Hz, which steps of {:.2g} s do not resolve",
                                   contact_frequency(scene) / (2.0 * std::numbers::pi), step);
  // A force that enters a beam excites all modes, the nth with an acceleration proportional to 1/n.
  if (why[acceleration].empty() && undamped) why[acceleration] = no_sum;
  return why;
}

/// Whether a quantity appears in a run. Axial quantities are close to rounding errors, unless they are controlled; a
/// filtered acceleration is present even if a run that ends early has no settled peak.
bool is_present(const Scene& scene, const run::ResponseExtremes& peaks, std::size_t q) {
  const bool axial = q == run::axial_displacement || q == run::axial_force;
  if (is_controlled(scene, q) && q == low_passed) return true;
  return peaks.largest(static_cast<run::Quantity>(q)).value != 0.0 && (!axial || is_controlled(scene, q));
}

/// The task of the search for a scene with its first mesh.
SearchTask task_of(const Scene& scene, const FirstSteps& steps) {
  SearchTask task;
  task.accuracy = scene.accuracy;
  task.open_mesh = scene.mesh_open;
  task.open_step = !scene.model.step;
  if (scene.beam->track) task.unit = "elements a sleeper bay";
  const int elements = scene.by_given_modes() ? 0 : mesh_of(scene);
  const double longest = 2.0 * steps.longest;
  task.coarse.step = task.open_step ? two_digits(std::min(search::first_ratio * steps.first, longest))
                                    : std::min(2.0 * *scene.model.step, std::max(longest, *scene.model.step));
  task.fine = {elements, task.open_step ? 0.5 * task.coarse.step : *scene.model.step};
  task.coarse.elements = elements % 2 == 0 ? elements / 2 : elements;
  const int dense = search::max_in_all / static_cast<int>(std::min<std::size_t>(scene.beam->spans.size(), 1000));
  task.most_elements =
      std::max(scene.beam->track ? search::max_in_a_bay : std::clamp(dense, 32, search::max_in_a_span), 8 * elements);
  return task;
}

// Steps that are long compared with the beam's first period give the static response to forces: the method damps the
// vibration at once. The dissipated energy is proportional to the square of the vibration's amplitude, relative to the
// static response.
void resolve_vibration(const Scene& scene, const FirstSteps& steps, TrialRuns& trials, SearchTask& task) {
  const double amplitude = search::share_of_vibration * scene.accuracy;
  while (steps.of_period > 0.0 && task.fine.step > steps.of_period &&
         trials.stored(task.fine).energy_missing > amplitude * amplitude) {
    task.fine.step = two_digits(std::max(search::energy_step_factor * task.fine.step, steps.of_period));
    task.coarse.step = 2.0 * task.fine.step;
  }
}

}  // namespace

const char* unit_of_mesh(const Scene& scene) { return scene.beam->track ? "sleeper bay" : "span"; }

ModelSearch::ModelSearch(MPI_Comm comm, const Scene& scene, const run::SharedBeam& shared, double end)
    : scene_(scene),
      steps_(first_steps(scene, shared.omega ? shared.omega->first : 0.0, end)),
      trials_(comm, scene, end),
      why_not_(
          reasons_against(scene, steps_, shared.rayleigh.b <= 0.0 && !scene.beam->track && !scene.by_given_modes())),
      search_(trials_, task()) {}

ModelSearch::ModelSearch(MPI_Comm comm, const Scene& scene, const std::string& state)
    : scene_(scene), trials_(comm, scene, 0.0), search_(trials_, task_of(scene, FirstSteps())) {
  base::Bytes bytes{std::span<const char>(state)};
  keep(bytes);
}

std::string ModelSearch::state() {
  base::Bytes bytes;
  keep(bytes);
  return bytes.written();
}

void ModelSearch::keep(base::Bytes& bytes) {
  bytes(scene_.model.vehicles, why_not_, search_);
  trials_.keep(bytes, search_.latest());
}

SearchTask ModelSearch::task() {
  SearchTask task = task_of(scene_, steps_);
  if (trials_.seconds(task.coarse) > search::max_seconds)
    throw InputError(fmt::format(
        "accuracy = {:g}: the first trial run would take {:.1g} steps of {:.1g} s with {} elements a {} ({}), which "
        "exceeds its limit; check the masses, stiffnesses and lengths of the scene, or set ts_dt and {} to avoid trial "
        "runs",
        scene_.accuracy, trials_.end() / task.coarse.step, task.coarse.step, task.coarse.elements, unit_of_mesh(scene_),
        task.open_step ? steps_.why : "the step is given",
        scene_.beam->track ? "track_elements_per_bay" : "beam_elements_per_span"));
  if (task.open_step) resolve_vibration(scene_, steps_, trials_, task);
  if (why_not_[acceleration].empty() && steps_.of_period > 0.0 && task.fine.step > steps_.of_period)
    why_not_[acceleration] =
        fmt::format("the beam vibrates with the first period of {:.3g} s, which steps of {:.2g} s do not resolve",
                    trial_steps_per_period * steps_.of_period, task.fine.step);
  const double amplification = trials_.stored(task.coarse).amplification;
  for (std::size_t q = 0; q < quantities; ++q) {
    if (why_not_[q].empty() && q != wheel_force && amplification < search::at_rest)
      why_not_[q] = fmt::format("in this run the bridge moves by {:.1g} of its static deflection only", amplification);
    task.wanted[q] = why_not_[q].empty();
  }
  return task;
}

void ModelSearch::add_last(const scene::NumericalModel& model, RunPeaks run) {
  const Discretisation last{search_.model().elements > 0 ? model.elements : 0, *model.step};
  trials_.store(last, std::move(run));
  search_.add_last(last);
}

Choice ModelSearch::choice() {
  Choice choice;
  choice.model = scene_.model;
  if (search_.model().elements > 0) choice.model.elements = search_.model().elements;
  choice.model.step = search_.model().step;
  choice.model.step_probes = true;
  choice.model.local_compliance = true;
  if (scene_.model.vehicles == scene::VehicleModel::automatic) {
    choice.model.vehicles = scene::VehicleModel::linear;
    choice.model.residual_limit = trials_.residual_limit();
  }
  choice.accuracy.measured = true;
  choice.accuracy.lost_contact = trials_.lost_contact();
  if (open()) return choice;
  const run::ResponseExtremes& peaks = trials_.stored(search_.model()).peaks;
  for (std::size_t q = 0; q < quantities; ++q) {
    ErrorEstimate& estimate = choice.accuracy.estimates[q];
    estimate.present = peaks.failed() || is_present(scene_, peaks, q);
    estimate.expected = search_.errors()[q];
    estimate.why_not = why_not_[q].empty() ? search_.why_not(q) : why_not_[q];
    estimate.accepted = estimate.why_not.empty();
    if (!is_optional(scene_, q) || !estimate.present || why_not_[q].empty()) continue;
    estimate.accepted = estimate.expected > 0.0 && estimate.expected <= scene_.accuracy;
    estimate.why_not = fmt::format("{}, and its error with the model for the other quantities is {:.1g}", why_not_[q],
                                   estimate.expected);
  }
  return choice;
}

}  // namespace traverse::error_control
