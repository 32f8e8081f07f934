// Sets up and runs batches of trial passages, and compares their peaks.
#include "error_control/batch_trial_runs.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <iterator>

#include "engine/processor.hpp"
#include "ensemble/batch_obstacle.hpp"
#include "error_control/accuracy.hpp"
#include "error_control/trial_runs.hpp"
#include "run/deck_acceleration.hpp"

namespace traverse::app {

using engine::BatchResult;

namespace {

/// Puts the peaks before the unsettled end into the result.
void filter_kept(BatchResult& result, std::size_t probes, double frequency, double interval) {
  if (result.trouble != engine::none) return;
  const std::size_t settled = filter(result.kept, probes, frequency, interval);
  ResponseExtremes peaks(std::vector<std::vector<double>>(probes), 0);
  peaks.add_low_passed(std::span<const double>(result.kept).first(settled * probes), interval);
  for (std::size_t p = 0; p < probes; ++p) {
    const Extreme& peak = peaks.largest_of_each(low_passed)[p];
    result.peaks[p].low_passed = {std::abs(peak.value), peak.time};
  }
  result.kept = {};
}

}  // namespace

PeakErrors difference(const Scene& scene, const std::vector<BatchResult>& rough, const std::vector<BatchResult>& fine) {
  PeakErrors worst{};
  for (std::size_t run = 0; run < rough.size(); ++run) {
    const bool failed = rough[run].trouble != engine::none || fine[run].trouble != engine::none;
    const PeakErrors own = failed ? PeakErrors{} : difference(scene, rough[run], fine[run]);
    for (std::size_t q = 0; q < quantities; ++q)
      if (asks_for(scene, q)) worst[q] = std::max(worst[q], failed ? 1.0 : own[q]);  // too long a step, most likely
  }
  return worst;
}

bool lose_contact(const std::vector<BatchResult>& runs) {
  return std::any_of(runs.begin(), runs.end(), [](const BatchResult& run) { return run.contact_losses > 0.0; });
}

BatchTrialRuns::BatchTrialRuns(Scene scene, const std::vector<std::vector<double>>& speeds, double distance,
                               const BatchTrialRuns* before)
    : scene_(std::move(scene)),
      before_(before != nullptr && before->scene_.beam->spans == scene_.beam->spans ? before : nullptr) {
  for (const std::vector<double>& group : speeds) {
    std::vector<LaneRun>& runs = groups_.emplace_back();
    for (const std::uint64_t seed : scene_.sweep->seeds)
      if (group.size() == 1 && runs.size() + 1 < engine::widest)
        runs.push_back({group.front(), distance / group.front(), seed});
    for (const double speed : group) runs.push_back({speed, distance / speed, {}});
  }
}

const std::vector<BatchResult>& BatchTrialRuns::run(const NumericalModel& model) {
  run_at_once({&model, 1});
  return known(model)->results;
}

void BatchTrialRuns::run_at_once(std::span<const NumericalModel> models) {
  std::vector<std::vector<CaseBatch::Ready>> ready;
  std::vector<NumericalModel> own;
  for (const NumericalModel& model : models) {
    if (known(model) != nullptr || std::find(own.begin(), own.end(), model) != own.end()) continue;
    own.push_back(model);
    check_memory(model);
    std::vector<CaseBatch::Ready>& groups = ready.emplace_back();
    for (const std::vector<LaneRun>& runs : groups_) groups.push_back(setup(model).lanes->ready(runs, steps_of(model)));
  }
  const auto results_of = [&](std::size_t i) { return run_all(ready[i], steps_of(own[i])); };
  std::vector<std::future<std::vector<BatchResult>>> others;
  for (std::size_t i = 1; i < own.size(); ++i) others.push_back(std::async(std::launch::async, results_of, i));
  for (std::size_t i = 0; i < own.size(); ++i) {
    Kept kept{own[i], i == 0 ? results_of(i) : others[i - 1].get(), 0.0};
    for (const BatchResult& result : kept.results)
      if (result.trouble == engine::none) kept.defect = std::max(kept.defect, setup(own[i]).lanes->defect(result));
    kept_.push_back(std::move(kept));
  }
}

void BatchTrialRuns::check_memory(const NumericalModel& model) const {
  const CaseBatch::Steps steps = steps_of(model);
  double numbers = 0.0;
  for (const std::vector<LaneRun>& runs : groups_) {
    const double places = runs.front().speed * runs.front().end / CaseBatch::spacing(steps, runs.front().speed);
    numbers += places * static_cast<double>(runs.size() * scene_.output.probes.size());
  }
  if (steps.keeps && numbers > DeckAcceleration::most_kept)
    throw Refused{"the accelerations of so many probes would have to be kept"};
}

CaseBatch::Steps BatchTrialRuns::steps_of(const NumericalModel& model) const {
  const structure::MethodRow& method = *structure::find_method(model.method);
  return {method.make(method.parameter.value), *model.step, true, asks_for(scene_, low_passed)};
}

/// Of one model, whose accelerations are filtered run by run: a place each step is an instant each interval of its own.
std::vector<BatchResult> BatchTrialRuns::run_all(const std::vector<CaseBatch::Ready>& groups,
                                                 const CaseBatch::Steps& steps) const {
  std::vector<BatchResult> results;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::vector<LaneRun>& runs = groups_[g];
    const double spacing = CaseBatch::spacing(steps, runs.front().speed);
    std::vector<BatchResult> own = groups[g].run();
    for (std::size_t i = 0; i < own.size() && steps.keeps; ++i)
      filter_kept(own[i], scene_.output.probes.size(), *scene_.output.low_pass, spacing / runs[i].speed);
    std::move(own.begin(), own.end(), std::back_inserter(results));
  }
  return results;
}

const BatchTrialRuns::Kept* BatchTrialRuns::known(const NumericalModel& model) const {
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.model == model; });
  return found == kept_.end() ? nullptr : &*found;
}

double BatchTrialRuns::defect(const NumericalModel& model) const { return known(model)->defect; }

BatchTrialRuns::Setup& BatchTrialRuns::setup(const NumericalModel& model) {
  std::unique_ptr<Setup>& place = setups_[model.elements];
  if (place) return *place;
  place = std::make_unique<Setup>();
  place->scene = with(scene_, model);
  if (const std::optional<beam::Rayleigh> known = damping()) place->scene.damping = {{{known->a, known->b}}, {}, {}};
  std::vector<std::string> ignored;
  place->shared.emplace(PETSC_COMM_SELF, place->scene, ignored);
  place->shared->damp(place->scene, first_omega_ == 0.0, ignored);
  if (first_omega_ == 0.0) first_omega_ = place->shared->omega->first;
  damping_ = place->shared->rayleigh;
  place->shared->prepare(place->scene, ignored);
  if (const std::string why = batch_obstacle(place->scene, *place->shared); !why.empty()) throw Refused{why};
  place->lanes.emplace(place->scene, *place->shared);
  if (!place->lanes->obstacle().empty()) throw Refused{place->lanes->obstacle()};
  return *place;
}

}  // namespace traverse::app
