// Trial runs of a scene. Every combination of mesh and step is computed once.
#include "error_control/trial_runs.hpp"

#include <algorithm>
#include <cmath>

#include "error_control/accuracy.hpp"
#include "error_control/search_constants.hpp"
#include "results/stage.hpp"
#include "run/deck_acceleration.hpp"
#include "run/rank_choice.hpp"
#include "run/simulation.hpp"

namespace traverse::error_control {

using scene::Scene;

namespace {

constexpr double max_excess =
    10.0;  // ratio of a residual to its limit above which linear vehicles are rejected at once
// Largest output interval over longest_spacing_for(). It is above 2, so that the comparison run with twice the step is
// included.
constexpr double interval_ratio = 2.1;
constexpr double max_shift = 3.0;  // steps of the coarser run: largest time difference of the same peak in two runs

/// Whether supports have dampers that act only in contact, so that accelerations jump.
bool has_contact_dampers(const scene::Scene& scene) {
  bool found = false;
  for_points(scene.beam->foundation, [&](const beam::FoundationKind&, const auto& points) {
    for (const beam::PointFoundation& point : points)
      found = found || (point.c > 0.0 && (point.law.one_sided || point.law.gap > 0.0));
  });
  return found;
}

/// Whether the acceleration, the wheel force or the low-passed acceleration is meant, which impacts determine.
bool is_of_impacts(std::size_t q) { return q == run::acceleration || q == run::wheel_force || q == run::low_passed; }

}  // namespace

RunPeaks peaks_of(MPI_Comm comm, const Scene& scene) {
  std::vector<std::string> ignored;
  run::SharedBeam shared(comm, scene, ignored);
  shared.set_up(scene, false, ignored);
  const double cutoff = run::filters_deck(scene) ? scene.output.low_pass.value_or(0.0) : 0.0;
  run::Simulation run(scene, shared, {.deck_cutoff = cutoff, .deck_spacing = interval_ratio, .filter_on_all = true},
                      ignored);
  shared.beam->release_matrices();
  const results::Stage stage("time steps");
  bool within_limit = true;
  run::ObserverBy limit(
      [&](const integrate::Instant&) {
        within_limit = run.system().linearisation_residual() <= scene.model.residual_limit;
      },
      [&](double t, long) {
        results::Stage::advance(t / run.plan().end_time);
        return within_limit;
      });
  run.run({&limit});
  RunPeaks result;
  run::Result found = run.result();
  const run::Extreme& largest = found.peaks.largest(run::deflection);
  const double at_rest =
      largest.value != 0.0 ? run.static_deflection(scene.output.probes[static_cast<std::size_t>(largest.place)]) : 0.0;
  if (at_rest > 0.0) result.amplification = std::abs(largest.value) / at_rest;
  result.peaks = std::move(found.peaks);
  result.lost_contact = found.lost_contact;
  result.residual = found.summary.linearisation_residual;
  if (found.summary.energy_scale > 0.0)
    result.energy_missing = found.summary.energy_residual / found.summary.energy_scale;
  return result;
}

TrialRuns::TrialRuns(MPI_Comm comm, Scene scene, double end)
    : comm_(comm), scene_(std::move(scene)), residual_limit_(default_residual_limit(scene_)) {
  scene_.end_time = end;
  scene_.quiet = true;
  scene_.model.step_probes = true;
  scene_.model.local_compliance = true;
}

PeakErrors TrialRuns::change(const Discretisation& coarse, const Discretisation& fine) {
  const run::ResponseExtremes &rough = stored(coarse).peaks, &exact = stored(fine).peaks;
  PeakErrors changes{};
  for (std::size_t q = 0; q < run::quantities; ++q)
    changes[q] = run::difference(rough, exact, static_cast<run::Quantity>(q), max_shift * coarse.step);
  return changes;
}

double TrialRuns::weight(std::size_t q) const {
  const bool sum_of_modes =
      q == run::moment && !damps_high_modes(scene_) && !scene_.beam->track && !scene_.by_given_modes();
  const double of_impacts = has_contact_dampers(scene_) ? search::weight_of_jumps
                            : lost_contact_             ? search::weight_of_impacts
                                                        : 1.0;
  return (is_of_impacts(q) ? of_impacts : 1.0) * (sum_of_modes ? search::weight_of_sum : 1.0) *
         (q == run::acceleration && !scene_.load.forces.empty() ? search::weight_of_forces : 1.0);
}

double TrialRuns::seconds(const Discretisation& model) {
  return *scene_.end_time / model.step * run::step_seconds(scene_, {}, model.elements);
}

int TrialRuns::mesh_of_at_least(int elements) const {
  return scene_.beam->track ? elements : aligned_mesh(scene_, 2 * ((elements + 1) / 2));
}

Scene TrialRuns::with_model(const Discretisation& model) const {
  scene::NumericalModel chosen = scene_.model;
  chosen.elements = model.elements;
  chosen.step = model.step;
  Scene scene = with(scene_, chosen);
  scene.output.interval = trial_steps_per_sample * model.step;
  return scene;
}

const RunPeaks& TrialRuns::stored(const Discretisation& model) {
  const auto known = std::ranges::find(stored_, model, &StoredRun::model);
  return known != stored_.end() ? known->run : stored_.emplace_back(StoredRun{model, computed(model)}).run;
}

void TrialRuns::keep(base::Bytes& bytes, std::span<const Discretisation> models) {
  bytes(*scene_.end_time, residual_limit_, measured_linearisation_, lost_contact_);
  for (const Discretisation& model : models) {
    RunPeaks run = bytes.reads() ? RunPeaks() : stored(model);
    bytes(run);
    if (bytes.reads()) store(model, std::move(run));
  }
}

RunPeaks TrialRuns::computed(const Discretisation& model) {
  Scene scene = with_model(model);
  const bool open = scene.model.vehicles == scene::VehicleModel::automatic;
  if (open) {
    scene.model.vehicles = scene::VehicleModel::linear;
    scene.model.residual_limit = residual_limit_;
  }
  RunPeaks result;
  try {
    result = peaks_of(comm_, scene);
    const bool measures = open && !measured_linearisation_ && result.residual > residual_limit_ &&
                          result.residual < max_excess * residual_limit_;
    if (measures) {
      measure_linearisation(model);
      scene.model.residual_limit = residual_limit_;
      if (result.residual <= residual_limit_) result = peaks_of(comm_, scene);
    }
  } catch (const SolverError&) {
    result.peaks = run::ResponseExtremes::of_failure();  // the step is probably too long
  }
  lost_contact_ = lost_contact_ || result.lost_contact;
  if (open && result.residual > residual_limit_) throw ResidualTooLarge{result.residual};
  return result;
}

// The step is doubled, because the error of linear vehicles hardly depends on it, unless it resolves the waves of a
// track.
void TrialRuns::measure_linearisation(const Discretisation& model) {
  measured_linearisation_ = true;
  const double step = std::isfinite(scene::shortest_wave(scene_)) ? model.step : 2.0 * model.step;
  residual_limit_ = measured_residual_limit(comm_, with_model({model.elements, step}));
}

}  // namespace traverse::error_control
