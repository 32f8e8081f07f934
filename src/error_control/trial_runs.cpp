// Trial runs of a shortened scene without distant spans and later vehicles. Every combination of mesh, step and
// integrator is computed once, and a limit of the total cost ends the series.
#include "error_control/trial_runs.hpp"

#include <algorithm>
#include <cmath>

#include "base/one_step_methods.hpp"
#include "error_control/search_constants.hpp"
#include "results/stage.hpp"
#include "run/deck_acceleration.hpp"
#include "run/rank_choice.hpp"
#include "run/simulation.hpp"

namespace traverse::error_control {

using scene::Scene;

namespace {

constexpr std::size_t margin_spans =
    8;  // spans beyond the train's range that remain, because waves propagate ahead of it
constexpr std::size_t max_whole_bridge = 24;  // bridges with at most this number of spans remain whole
constexpr double max_excess =
    10.0;  // ratio of a residual to its limit above which linear vehicles are rejected at once
// Largest output interval over longest_spacing_for(). It is above 2, so that the comparison run with twice the step is
// included.
constexpr double interval_ratio = 2.1;
constexpr double solves_per_step = 5.0;  // solves of the beam's equations in a step of the default method
constexpr double lead = 12.0;            // bays before the bridge, over which the transient of the start decays

double foremost(const Scene& scene, std::size_t vehicle) {
  const std::vector<double> wheels = scene::wheels_at_start(scene, vehicle);
  return wheels.empty() ? 0.0 : *std::max_element(wheels.begin(), wheels.end());
}

void remove_late_vehicles(Scene& scene, double end) {
  train::Train& train = scene.train;
  if (train.drive != train::Drive::constant || !train.couplers.empty() || !train.courses.empty()) return;
  std::size_t count = 1;
  for (std::size_t i = 1; i < train.vehicles.size(); ++i)
    if (foremost(scene, i) + train.speed * end > 0.0) count = i + 1;
  count = std::min(count, train.vehicles.size());
  train.vehicles.resize(count);
  train.positions.resize(count);
}

void remove_distant_spans(Scene& scene, double end) {
  beam::BeamModel& beam = *scene.beam;
  const auto is_present = [&](const beam::FoundationKind& kind) { return present(beam.foundation, kind); };
  const bool has_foundation = std::any_of(beam::foundation_kinds.begin(), beam::foundation_kinds.end(), is_present);
  const bool plain = !has_foundation && !beam.track && beam.hinges.empty() && beam.cracks.empty() && !beam.strained();
  if (!plain || beam.spans.size() <= max_whole_bridge || scene.train.drive != train::Drive::constant ||
      !scene.train.courses.empty() || !scene.load.courses.empty())
    return;
  double front = scene.output.probes.empty() ? 0.0 : scene.output.probes.front();
  if (!scene.train.vehicles.empty()) front = std::max(front, foremost(scene, 0) + scene.train.speed * end);
  for (const double x : scene.load.positions) front = std::max(front, x + scene.load.speed * end);
  std::size_t count = 0;
  for (double x = 0.0; count < beam.spans.size() && x < front; ++count) x += beam.spans[count];
  count = std::min(beam.spans.size(), count + margin_spans);
  beam.spans.resize(count);
  beam.elements.resize(count);
  beam.supports.resize(count + 1);
  if (beam.joints.size() > 1) beam.joints.resize(count - 1);
  std::erase_if(scene.output.probes, [&](double x) { return x > beam.length(); });
}

}  // namespace

Scene trim_approach(const Scene& scene) {
  Scene part = scene;
  if (!scene.beam->track || scene.train.vehicles.empty() || !scene.load.forces.empty() || !scene.profile.level() ||
      !scene.beam->track->uniform() || !scene.beam->track->rail_hinges.empty() ||
      !scene.beam->track->expansion_devices.empty() || scene.train.drive != train::Drive::constant ||
      !scene.train.courses.empty())
    return part;
  const std::vector<double> wheels = scene::wheels_at_start(scene);
  const double front = *std::max_element(wheels.begin(), wheels.end());
  beam::LayeredTrack& track = *part.beam->track;
  const double bays = std::min(std::floor(-front / track.spacing - lead), std::floor(track.approach / track.spacing));
  if (!(bays > 0.0)) return part;
  track.approach -= bays * track.spacing;
  for (double& x : part.train.positions) x += bays * track.spacing;
  return part;
}

Scene restrict_to_window(const Scene& scene, double end) {
  Scene part = scene;
  part.end_time = end;
  part.quiet = true;
  part.model.step_probes = true;
  part.model.local_compliance = true;
  remove_late_vehicles(part, end);
  remove_distant_spans(part, end);
  return part;
}

RunPeaks peaks_of(MPI_Comm comm, const Scene& scene, double max_cost) {
  std::vector<std::string> ignored;
  run::SharedBeam shared(comm, scene, ignored);
  shared.set_up(scene, false, ignored);
  const double cutoff = run::filters_deck(scene) ? scene.output.low_pass.value_or(0.0) : 0.0;
  run::Simulation run(scene, shared, {.deck_cutoff = cutoff, .deck_spacing = interval_ratio, .filter_on_all = true},
                      ignored);
  shared.beam->release_matrices();
  const auto cost_in_steps = [&] {
    const double by_solves = static_cast<double>(run.system().beam_solves()) / solves_per_step;
    return std::max(static_cast<double>(run.passage().steps()), by_solves) +
           run::steps_per_factorisation * static_cast<double>(run.system().factorisations());
  };
  const results::Stage stage("time steps");
  RunPeaks result;
  bool within_limit = true;
  run::ObserverBy limits(
      [&](const integrate::Instant&) {
        within_limit = run.system().linearisation_residual() <= scene.model.residual_limit;
      },
      [&](double t, long) {
        results::Stage::advance(t / run.plan().end_time);
        result.complete = within_limit && cost_in_steps() <= max_cost;
        return result.complete;
      });
  run.run({&limits});
  result.steps = cost_in_steps();
  run::Result found = run.result();
  result.peaks = std::move(found.peaks);
  result.lost_contact = found.lost_contact;
  result.residual = found.summary.linearisation_residual;
  if (found.summary.energy_scale > 0.0)
    result.energy_missing = found.summary.energy_residual / found.summary.energy_scale;
  return result;
}

double TrialRuns::seconds(int elements, double step, const std::string& integrator) const {
  return *scene_.end_time / step * run::step_seconds(scene_, integrator, elements);
}

double TrialRuns::seconds() const {
  double sum = 0.0;
  for (const StoredRun& run : stored_) sum += seconds(run.model.elements, *run.model.step, run.model.method);
  return sum;
}

const run::ResponseExtremes& TrialRuns::run(int elements, double step, const std::string& integrator) {
  return stored_run(elements, step, integrator).peaks;
}

double TrialRuns::energy_missing(int elements, double step) { return stored_run(elements, step, {}).energy_missing; }

const TrialRuns::StoredRun& TrialRuns::stored_run(int elements, double step, const std::string& integrator) {
  scene::NumericalModel model = scene_.model;
  model.elements = elements;
  model.step = step;
  model.method = integrator;
  for (const StoredRun& known : stored_)
    if (known.model == model) return known;
  Scene scene = with(scene_, model);
  scene.output.interval = trial_steps_per_sample * step;
  if (scene.model.vehicles == scene::VehicleModel::automatic) {
    scene.model.vehicles = scene::VehicleModel::linear;
    scene.model.residual_limit = residual_limit_;
  }
  const double seconds_per_step = run::step_seconds(scene_, {}, elements),
               max_cost = (search::max_seconds - spent_) / seconds_per_step;
  RunPeaks result;
  try {
    if (*scene_.end_time / step > max_cost) throw CostLimitExceeded();
    result = peaks_of(comm_, scene, max_cost);
    if (needs_measurement(result.residual)) {
      measure_linearisation(elements, step);
      scene.model.residual_limit = residual_limit_;
      if (result.residual <= residual_limit_) result = peaks_of(comm_, scene, max_cost);
    }
  } catch (const SolverError&) {
    result.peaks = run::ResponseExtremes::of_failure();  // the step is probably too long
  }
  spent_ += result.steps * seconds_per_step;
  lost_contact_ = lost_contact_ || result.lost_contact;
  if (scene_.model.vehicles == scene::VehicleModel::automatic && result.residual > residual_limit_)
    throw ResidualTooLarge{result.residual};
  if (!result.complete) throw CostLimitExceeded();
  return stored_.emplace_back(StoredRun{model, std::move(result.peaks), result.energy_missing});
}

bool TrialRuns::needs_measurement(double residual) const {
  return scene_.model.vehicles == scene::VehicleModel::automatic && !measured_linearisation_ &&
         residual > residual_limit_ && residual < max_excess * residual_limit_;
}

// The step is doubled, because the error of linear vehicles hardly depends on it.
void TrialRuns::measure_linearisation(int elements, double step) {
  measured_linearisation_ = true;
  scene::NumericalModel model = scene_.model;
  model.elements = elements;
  model.step = 2.0 * step;
  const Scene scene = with(scene_, model);
  residual_limit_ = measured_residual_limit(comm_, scene);
  spent_ += 2.0 * seconds(elements, *scene.model.step);
}

}  // namespace traverse::error_control
