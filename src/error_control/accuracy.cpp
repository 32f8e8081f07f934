// Chooses mesh and time step for a wanted error of the peaks: prepares beam, damping and filter frequency, runs the
// error search, and repeats it with the mechanisms if linear vehicles are not accurate enough.
#include "error_control/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>

#include "error_control/initial_guess.hpp"
#include "error_control/model_search.hpp"
#include "error_control/modes_for_damping.hpp"
#include "error_control/multibody_step_search.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"
#include "results/stage.hpp"
#include "run/deck_acceleration.hpp"
#include "run/passage.hpp"
#include "traverse/options/input.hpp"

namespace traverse::error_control {

using run::acceleration;
using run::low_passed;
using run::shear_force;
using run::wheel_force;
using scene::Scene;

namespace {

constexpr std::size_t min_continuous_spans = 200;  // from this number of continuous spans the active window is used

void limit_to_active_window(const Scene& scene, scene::NumericalModel& model) {
  const beam::BeamModel& beam = *scene.beam;
  if (model.window_tolerance < 0.0 && !beam.track && !beam.all_separate() && beam.spans.size() >= min_continuous_spans)
    model.window_tolerance = search::share_of_active_window * scene.accuracy;
}

void describe(const Scene& scene, const ModelSearch& search, const Choice& choice, std::vector<std::string>& notes) {
  const std::string mesh =
      scene.by_given_modes() ? "" : fmt::format("{} elements a {}, ", choice.model.elements, unit_of_mesh(scene));
  notes.push_back(fmt::format("accuracy {:g}: {}steps of {:.3g} s; {} trial runs took {:.2g} s", scene.accuracy, mesh,
                              *choice.model.step, search.trials(), choice.accuracy.seconds));
  if (search.open()) return;
  std::vector<std::string> lines = choice.accuracy.lines();
  std::ranges::move(lines, std::back_inserter(notes));
}

}  // namespace

bool chooses(const Scene& scene) {
  const bool open = scene.mesh_open || !scene.model.step;
  const bool moves = !scene.train.vehicles.empty() || !scene.load.forces.empty();
  return open && moves && scene.beam && scene.analysis == options::Analysis::transient &&
         (scene.model.modes == 0 || (scene.by_given_modes() && !scene.exact_in_time()));
}

void set_first_mesh(Scene& scene) {
  if (!scene.mesh_open) return;
  const int elements = first_mesh(scene), half = aligned_mesh(scene, elements / 2);
  set_mesh(scene, 2 * half > elements ? 2 * half : aligned_mesh(scene, elements, 2.0));
}

void set_low_pass(MPI_Comm comm, Scene& scene, std::vector<std::string>& notes) {
  if (!run::filters_deck(scene) || scene.output.low_pass) return;
  Scene known = scene;
  set_first_mesh(known);
  std::vector<std::string> ignored;
  run::SharedBeam shared(comm, known, ignored);
  shared.damp(known, false, ignored);
  if (known.model.modes > 0) shared.prepare(known, ignored);
  const bool affordable = scene.limits_deck_acceleration() || run::frequencies_are_cheap(*shared.beam);
  scene.output.low_pass = run::cutoff_frequency(known, shared, affordable, notes);
}

const options::Entry* adaptive_step_option(const Scene& scene) {
  const options::Entry* control = scene.find_option("ts_adapt_type");
  return control != nullptr && control->value != "none" ? control : nullptr;
}

namespace {

/// Whether no limit applies to the unfiltered acceleration, which needs far more modes and shorter steps.
bool limits_filtered_only(const Scene& scene) { return scene.limits_deck_acceleration() && run::filters_deck(scene); }

}  // namespace

bool is_controlled(const Scene& scene, std::size_t quantity) {
  if (quantity == low_passed && !run::filters_deck(scene)) return false;
  const std::vector<std::string>& given = scene.accuracy_of;
  if (!given.empty()) return std::find(given.begin(), given.end(), run::stored_names[quantity]) != given.end();
  if (quantity == acceleration) return !limits_filtered_only(scene);
  return !run::by_elements_only(quantity) || (quantity != shear_force && pushes_along(scene));
}

bool is_optional(const Scene& scene, std::size_t quantity) {
  return scene.accuracy_of.empty() && quantity == shear_force;
}

std::string why_not_controlled(const Scene& scene, std::size_t quantity) {
  return quantity == acceleration && scene.accuracy_of.empty()
             ? "the limits apply to the low-passed acceleration; accuracy_of can include both"
             : "accuracy_of does not include it";
}

bool controls_forces_only(const Scene& scene) {
  return is_controlled(scene, wheel_force) && !is_controlled(scene, acceleration);
}

bool damps_high_modes(const Scene& scene) {
  const scene::Damping& damping = scene.damping;
  return (damping.ratios && damping.ratios->second > 0.0) || (damping.rayleigh && damping.rayleigh->second > 0.0);
}

bool damps_all_modes(const Scene& scene) {
  const scene::Damping& damping = scene.damping;
  if (scene.by_given_modes()) {
    const std::vector<double>& ratio = scene.beam->given->ratio;
    return std::all_of(ratio.begin(), ratio.end(), [](double one) { return one > 0.0; });
  }
  return (damping.ratios && damping.ratios->first > 0.0) ||
         (damping.rayleigh && std::max(damping.rayleigh->first, damping.rayleigh->second) > 0.0);
}

Choice choose(MPI_Comm comm, const Scene& scene, std::vector<std::string>& notes, std::shared_ptr<ModelSearch>* open) {
  Choice none{scene.model, {}, {}, {}};
  if (takes_modes_for_damping(scene))
    if (Choice by_modes = modes_for_damping(comm, scene, notes); by_modes.model.modes > 0) return by_modes;
  const bool without_bridge = chooses_multibody_step(scene);
  if (!without_bridge && !chooses(scene)) return none;
  if (const options::Entry* option = adaptive_step_option(scene)) {
    notes.push_back(fmt::format(
        "accuracy {:g} has no effect: trial runs do not choose mesh and step, and errors are not estimated: {}",
        scene.accuracy, option->given()));
    return none;
  }
  if (without_bridge) return choose_multibody_step(comm, scene, notes);
  const results::Stage stage("trial runs");
  const options::WithoutMonitors without_monitors;
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::string> ignored;
  Scene known = scene;
  set_first_mesh(known);
  run::SharedBeam shared(comm, known, ignored);
  shared.set_up(known, true, ignored);
  known.damping.ratios.reset();
  known.damping.rayleigh = {shared.rayleigh.a, shared.rayleigh.b};
  set_low_pass(comm, known, ignored);
  const double end = run::Passage(known, shared, ignored).plan().end_time;
  std::shared_ptr<ModelSearch> search;
  const auto find = [&] {
    search = std::make_shared<ModelSearch>(comm, known, shared, end);
    search->run(open != nullptr);
  };
  try {
    find();
  } catch (const ResidualTooLarge& linear) {
    notes.push_back(
        fmt::format("vehicles are not linearised: the residual would be {:.1g} of their weights", linear.residual));
    known.model.vehicles = scene::VehicleModel::full;
    find();
  }
  Choice choice = search->choice();
  limit_to_active_window(scene, choice.model);
  choice.accuracy.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  describe(scene, *search, choice, notes);
  if (search->open()) *open = std::move(search);
  return choice;
}

namespace {

/// The scene with twice the elements in every span (or sleeper bay) and half the step.
Scene refined(const Scene& scene) {
  Scene fine = scene;
  if (fine.beam->track)
    fine.beam->track->elements_per_bay *= 2;
  else if (!fine.by_given_modes())
    for (int& elements : fine.beam->elements) elements *= 2;
  fine.model.step = 0.5 * *scene.model.step;
  return fine;
}

}  // namespace

bool report(MPI_Comm comm, const Scene& scene, const Accuracy& accuracy, const run::ResponseExtremes& peaks) {
  if (!scene.beam) return report_multibody(comm, scene, accuracy);
  const Scene fine = refined(scene);
  const run::ResponseExtremes truth = [&] {
    const results::Stage stage("the refined run of -accuracy_report");
    const options::WithoutMonitors without_monitors;
    return peaks_of(comm, fine).peaks;
  }();
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  int all_kept = 1;
  if (rank == 0) report_head("half the step and elements half as long", "peak of");
  for (std::size_t i = 0; i < run::quantities; ++i) {
    const auto q = static_cast<run::Quantity>(i);
    if (truth.largest(q).value == 0.0) continue;
    const double error = run::peak_difference(peaks, truth, q);
    const bool kept = report_row(run::quantity_names[i], accuracy.estimates[i], scene.accuracy, error, rank == 0);
    all_kept = kept ? all_kept : 0;
  }
  MPI_Bcast(&all_kept, 1, MPI_INT, 0, comm);  // only the first rank has the low-passed accelerations
  return all_kept != 0;
}

}  // namespace traverse::error_control
