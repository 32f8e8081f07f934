// Sets up and runs batches of trial passages, and compares their peaks.
#include "error_control/batch_trial_runs.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <iterator>

#include "engine/processor.hpp"
#include "error_control/accuracy.hpp"
#include "error_control/trial_runs.hpp"
#include "run/deck_acceleration.hpp"

namespace traverse::error_control {

using engine::BatchResult;
using ensemble::CaseBatch;
using scene::NumericalModel;

namespace {

/// Filters the stored accelerations and sets the peaks before the unsettled end.
void filter_stored(BatchResult& result, std::size_t probes, double frequency, double interval) {
  if (result.failure != engine::none) return;
  const std::size_t settled = run::filter(result.samples, probes, frequency, interval);
  run::ResponseExtremes peaks(probes, 0);
  peaks.add_low_passed(std::span<const double>(result.samples).first(settled * probes), interval);
  for (std::size_t p = 0; p < probes; ++p) {
    const base::Extreme& peak = peaks.largest_of_each(run::low_passed)[p];
    result.peaks[p].low_passed = {std::abs(peak.value), peak.time};
  }
  result.samples = {};
}

}  // namespace

PeakErrors difference(const scene::Scene& scene, const std::vector<BatchResult>& rough,
                      const std::vector<BatchResult>& fine) {
  PeakErrors worst{};
  for (std::size_t run = 0; run < rough.size(); ++run) {
    const bool failed = rough[run].failure != engine::none || fine[run].failure != engine::none;
    const PeakErrors errors = failed ? PeakErrors{} : difference(scene, rough[run], fine[run]);
    for (std::size_t q = 0; q < run::quantities; ++q)
      if (is_controlled(scene, q))
        worst[q] = std::max(worst[q], failed ? 1.0 : errors[q]);  // the step is probably too long
  }
  return worst;
}

bool any_contact_loss(const std::vector<BatchResult>& runs) {
  return std::any_of(runs.begin(), runs.end(), [](const BatchResult& run) { return run.contact_losses > 0.0; });
}

BatchTrialRuns::BatchTrialRuns(scene::Scene scene, const std::vector<std::vector<double>>& speeds, double distance)
    : scene_(std::move(scene)) {
  for (const std::vector<double>& group : speeds) {
    std::vector<ensemble::LaneRun>& runs = groups_.emplace_back();
    for (const std::uint64_t seed : scene_.sweep->seeds)
      if (group.size() == 1 && runs.size() + 1 < engine::widest)
        runs.push_back({group.front(), distance / group.front(), seed});
    for (const double speed : group) runs.push_back({speed, distance / speed, {}});
  }
}

const std::vector<BatchResult>& BatchTrialRuns::run(const NumericalModel& model) {
  if (const StoredRuns* known = find(model)) return known->results;
  check_memory(model);
  CaseBatch& lanes = *setup(model).lanes;
  const CaseBatch::Steps steps = steps_of(model);
  std::vector<std::future<std::vector<BatchResult>>> groups;
  for (const std::vector<ensemble::LaneRun>& runs : groups_)
    groups.push_back(std::async(std::launch::async,
                                [&, ready = lanes.ready(runs, steps)] { return run_group(ready, runs, steps); }));
  StoredRuns stored{model, {}, 0.0};
  for (std::future<std::vector<BatchResult>>& group : groups)
    std::ranges::move(group.get(), std::back_inserter(stored.results));
  for (const BatchResult& result : stored.results)
    if (result.failure == engine::none) stored.residual = std::max(stored.residual, lanes.residual(result));
  return stored_.emplace_back(std::move(stored)).results;
}

void BatchTrialRuns::check_memory(const NumericalModel& model) const {
  const CaseBatch::Steps steps = steps_of(model);
  double numbers = 0.0;
  for (const std::vector<ensemble::LaneRun>& runs : groups_) {
    const double places = runs.front().speed * runs.front().end / CaseBatch::spacing(steps, runs.front().speed);
    numbers += places * static_cast<double>(runs.size() * scene_.output.probes.size());
  }
  if (!steps.stored.empty() && numbers > run::DeckAcceleration::max_stored)
    throw Refused{"storing the accelerations of all probes needs too much memory"};
}

CaseBatch::Steps BatchTrialRuns::steps_of(const NumericalModel& model) const {
  const base::MethodRow& method = *base::find_method(model.method);
  CaseBatch::Steps steps{method.make(method.parameter.value), *model.step, true};
  if (is_controlled(scene_, run::low_passed)) steps.stored = {engine::Response::acceleration};
  return steps;
}

/// Runs a batch. Its accelerations are filtered run by run, because one place per step is a different time interval in
/// each run.
std::vector<BatchResult> BatchTrialRuns::run_group(const CaseBatch::Ready& ready,
                                                   const std::vector<ensemble::LaneRun>& runs,
                                                   const CaseBatch::Steps& steps) const {
  std::vector<BatchResult> results = ready.run();
  const double spacing = CaseBatch::spacing(steps, runs.front().speed);
  for (std::size_t i = 0; i < results.size() && !steps.stored.empty(); ++i)
    filter_stored(results[i], scene_.output.probes.size(), *scene_.output.low_pass, spacing / runs[i].speed);
  return results;
}

const BatchTrialRuns::StoredRuns* BatchTrialRuns::find(const NumericalModel& model) const {
  const auto found =
      std::find_if(stored_.begin(), stored_.end(), [&](const StoredRuns& k) { return k.model == model; });
  return found == stored_.end() ? nullptr : &*found;
}

double BatchTrialRuns::residual(const NumericalModel& model) const { return find(model)->residual; }

BatchTrialRuns::Setup& BatchTrialRuns::setup(const NumericalModel& model) {
  std::unique_ptr<Setup>& slot = setups_[model.elements];
  if (slot) return *slot;
  slot = std::make_unique<Setup>();
  slot->scene = with(scene_, model);
  if (damping_) slot->scene.damping = {{{damping_->a, damping_->b}}, {}, {}};
  std::vector<std::string> ignored;
  slot->shared.emplace(PETSC_COMM_SELF, slot->scene, ignored);
  slot->shared->damp(slot->scene, first_omega_ == 0.0, ignored);
  if (first_omega_ == 0.0) first_omega_ = slot->shared->omega->first;
  damping_ = slot->shared->rayleigh;
  slot->shared->prepare(slot->scene, ignored);
  std::string why;
  slot->lanes = CaseBatch::make(slot->scene, *slot->shared, 0.0, why);
  if (!slot->lanes) throw Refused{why};
  return *slot;
}

}  // namespace traverse::error_control
