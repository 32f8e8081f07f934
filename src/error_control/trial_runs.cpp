// Trial runs of a shortened scene: distant spans and later vehicles are left out, every combination of mesh, step and
// integrator is computed once, and a limit on the total cost ends the series.
#include "error_control/trial_runs.hpp"

#include <algorithm>
#include <cmath>

#include "base/one_step_methods.hpp"
#include "error_control/search_constants.hpp"
#include "results/stage.hpp"
#include "run/deck_acceleration.hpp"
#include "run/passage.hpp"
#include "run/run_observer.hpp"
#include "run/step_cost.hpp"

namespace traverse::app {
namespace {

constexpr std::size_t margin_spans = 8;         // kept beyond what the train reaches: waves run ahead of it
constexpr std::size_t few_spans = 24;           // are all kept
constexpr double steps_a_check = 32.0;          // of the energies; peaks are looked for at every step
constexpr double hopeless = 10.0;               // times what linear vehicles may be out of balance by
constexpr double twice_as_long = 2.1;           // steps than a run may have, for comparison
constexpr double solves_a_step = 5.0;           // of the beam, by the default method
constexpr double steps_a_factorisation = 30.0;  // that would cost as much as a step of a new length
constexpr double lead = 12.0;                   // bays before the bridge: the start has died away by then

double foremost(const Scene& scene, std::size_t vehicle) {
  const std::vector<double> wheels = wheels_at_start(scene, vehicle);
  return wheels.empty() ? 0.0 : *std::max_element(wheels.begin(), wheels.end());
}

void leave_out_vehicles(Scene& scene, double end) {
  Train& train = scene.train;
  if (train.drive != train::Drive::constant || !train.couplers.empty() || !train.courses.empty()) return;
  std::size_t count = 1;
  for (std::size_t i = 1; i < train.vehicles.size(); ++i)
    if (foremost(scene, i) + train.speed * end > 0.0) count = i + 1;
  count = std::min(count, train.vehicles.size());
  train.vehicles.resize(count);
  train.positions.resize(count);
}

void leave_out_spans(Scene& scene, double end) {
  beam::BeamModel& beam = *scene.beam;
  const auto there = [&](const beam::FoundationKind& kind) { return present(beam.foundation, kind); };
  const bool founded = std::any_of(beam::foundation_kinds.begin(), beam::foundation_kinds.end(), there);
  const bool plain = !founded && !beam.track && beam.hinges.empty() && beam.cracks.empty() && !beam.strained();
  if (!plain || beam.spans.size() <= few_spans || scene.train.drive != train::Drive::constant ||
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

/// Whether a run's steps see the frequency at which its accelerations are filtered.
bool keeps_accelerations(const Scene& scene, const Plan& plan) {
  const double frequency = filters_deck(scene) ? scene.output.low_pass.value_or(0.0) : 0.0;
  const double numbers = static_cast<double>(scene.output.probes.size()) * plan.end_time / plan.interval;
  return frequency > 0.0 && plan.interval <= twice_as_long * longest_spacing_for(frequency) &&
         numbers <= DeckAcceleration::most_kept;
}

}  // namespace

Scene trim_approach(const Scene& scene) {
  Scene part = scene;
  if (!scene.beam->track || scene.train.vehicles.empty() || !scene.load.forces.empty() || !scene.profile.level() ||
      !scene.beam->track->uniform() || !scene.beam->track->rail_hinges.empty() ||
      !scene.beam->track->expansion_devices.empty() || scene.train.drive != train::Drive::constant ||
      !scene.train.courses.empty())
    return part;
  const std::vector<double> wheels = wheels_at_start(scene);
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
  leave_out_vehicles(part, end);
  leave_out_spans(part, end);
  return part;
}

RunPeaks peaks_of(MPI_Comm comm, const Scene& scene, double most_steps) {
  std::vector<std::string> ignored;
  SharedBeam shared(comm, scene, ignored);
  shared.damp(scene, false, ignored);
  shared.prepare(scene, ignored);
  Passage passage(scene, shared, ignored);
  passage.start(ignored);
  shared.beam->release_matrices();
  results::Recorder none(PETSC_COMM_SELF, "", {}, {}, {});
  RunObserver watch(scene, passage.system(), shared.bridge(), none);
  if (keeps_accelerations(scene, passage.plan()))
    watch.keep_accelerations({*scene.output.low_pass, passage.plan(), scene.output.probes});
  RunPeaks result;
  const auto steps_so_far = [&] {
    const double by_solves = static_cast<double>(passage.system().beam_solves()) / solves_a_step;
    return std::max(static_cast<double>(passage.steps()), by_solves) +
           steps_a_factorisation * static_cast<double>(passage.system().factorisations());
  };
  const results::Stage stage("time steps");
  bool balanced = true;
  passage.run(
      [&](const integrate::Instant& instant) {
        watch.sample(instant);
        balanced = passage.system().defect() <= scene.model.most_residual;
      },
      [&](double t, long) {
        watch.step(t);
        results::Stage::advance(t / passage.plan().end_time);
        result.complete = balanced && steps_so_far() <= most_steps;
        return result.complete;
      });
  result.steps = steps_so_far();
  result.defect = passage.system().defect();
  for (const train::Separation& s : passage.system().contacts().separations().list())
    result.lost_contact = result.lost_contact || !s.from_start;
  result.peaks = watch.finished_peaks();
  const results::Summary& energies = watch.extremes();
  if (energies.energy_scale > 0.0) result.energy_missing = energies.energy_residual / energies.energy_scale;
  return result;
}

double TrialRuns::seconds(int elements, double step, const std::string& integrator) const {
  return *scene_.end_time / step * step_seconds(scene_, integrator, elements);
}

double TrialRuns::seconds() const {
  double sum = 0.0;
  for (const Kept& run : kept_) sum += seconds(run.model.elements, *run.model.step, run.model.method);
  return sum;
}

const ResponseExtremes& TrialRuns::run(int elements, double step, const std::string& integrator) {
  return kept_run(elements, step, integrator).peaks;
}

double TrialRuns::energy_missing(int elements, double step) { return kept_run(elements, step, {}).energy_missing; }

const TrialRuns::Kept& TrialRuns::kept_run(int elements, double step, const std::string& integrator) {
  NumericalModel model = scene_.model;
  model.elements = elements;
  model.step = step;
  model.method = integrator;
  for (const Kept& known : kept_)
    if (known.model == model) return known;
  Scene scene = with(scene_, model);
  scene.output.interval = steps_a_check * step;
  if (scene.model.vehicles == VehicleModel::automatic) {
    scene.model.vehicles = VehicleModel::linear;
    scene.model.most_residual = most_defect_;
  }
  const double a_step = step_seconds(scene_, {}, elements), most_steps = (search::most_seconds - spent_) / a_step;
  RunPeaks result;
  try {
    if (*scene_.end_time / step > most_steps) throw TooMuchWork();
    result = peaks_of(comm_, scene, most_steps);
    if (linear_is_in_doubt(result.defect)) {
      measure_linear(elements, step);
      scene.model.most_residual = most_defect_;
      if (result.defect <= most_defect_) result = peaks_of(comm_, scene, most_steps);
    }
  } catch (const SolverError&) {
    result.peaks = ResponseExtremes::of_failure();  // too long a step, most likely
  }
  spent_ += result.steps * a_step;
  lost_contact_ = lost_contact_ || result.lost_contact;
  if (scene_.model.vehicles == VehicleModel::automatic && result.defect > most_defect_) throw NotLinear{result.defect};
  if (!result.complete) throw TooMuchWork();
  return kept_.emplace_back(Kept{model, std::move(result.peaks), result.energy_missing});
}

bool TrialRuns::linear_is_in_doubt(double defect) const {
  return scene_.model.vehicles == VehicleModel::automatic && !measured_linear_ && defect > most_defect_ &&
         defect < hopeless * most_defect_;
}

// By twice the step: what linear vehicles neglect hardly depends on it.
void TrialRuns::measure_linear(int elements, double step) {
  measured_linear_ = true;
  NumericalModel model = scene_.model;
  model.elements = elements;
  model.step = 2.0 * step;
  const Scene scene = with(scene_, model);
  most_defect_ = tolerable_defect(comm_, scene);
  spent_ += 2.0 * seconds(elements, *scene.model.step);
}

}  // namespace traverse::app
