// Series of a run are shortened to its own end, and filtered as those of a single run with that interval.
#include "ensemble/batch_limits.hpp"

#include <algorithm>
#include <cmath>

#include "run/deck_acceleration.hpp"
#include "run/plan.hpp"
#include "run/wheel_unloading.hpp"

namespace traverse::ensemble {
namespace {

constexpr double same_instant = 1e-9;  // relative to the interval

/// The rows of a series up to the end of a run.
std::vector<double> until_end(const std::vector<double>& series, std::size_t width, const run::Plan& plan) {
  const auto instants = static_cast<std::size_t>(std::floor(plan.end_time / plan.interval + same_instant)) + 1;
  const std::size_t numbers = std::min(series.size(), instants * width);
  return {series.begin(), series.begin() + static_cast<std::ptrdiff_t>(numbers)};
}

}  // namespace

BatchLimits::BatchLimits(const scene::Scene& scene, const CaseBatch& lanes, double cutoff_frequency)
    : scene_(scene),
      lanes_(lanes),
      cutoff_frequency_(cutoff_frequency),
      filters_deck_(cutoff_frequency > 0.0 && scene.limits_deck_acceleration()),
      filters_wheels_(run::filters_wheels(scene)) {}

CaseBatch::Steps BatchLimits::steps() const {
  CaseBatch::Steps steps = lanes_.steps();
  if (filters_deck_) steps.stored = {engine::Response::acceleration};
  steps.stores_wheels = filters_wheels_;
  if (std::isfinite(scene_.sampling_interval))
    steps.stored_each =
        std::max(1L, static_cast<long>(std::floor(scene_.sampling_interval / steps.longest + same_instant)));
  return steps;
}

std::vector<results::EvaluatedQuantity> BatchLimits::evaluate(const LaneRun& run, const engine::BatchResult& result,
                                                              std::span<const double> static_deflection) const {
  run::LimitCheck check(scene_, lanes_.fleet(), &lanes_.beam());
  for (const base::Extreme& rotation : result.rotations) check.rotation(rotation);
  for (const base::Extreme& car : result.car_accelerations) check.car(car);

  run::Plan plan;
  plan.end_time = run.end;
  plan.interval = CaseBatch::spacing(steps(), run.speed_of_steps()) / run.speed;
  const std::size_t probes = result.peaks.size(), wheels = lanes_.wheels();
  const auto can_filter = [&](double frequency, std::size_t series) {
    return run::filter_obstacle(frequency, plan, series).empty();
  };
  results::Summary summary;
  if (filters_deck_ && can_filter(cutoff_frequency_, probes)) {
    std::vector<double> rows = until_end(result.samples, probes, plan);
    run::filter(rows, probes, cutoff_frequency_, plan.interval);
    summary.low_passed = run::low_passed_peak(run::largest_peak(rows, probes, plan.interval), scene_.output.probes,
                                              cutoff_frequency_, plan.interval);
  }
  summary.least_wheel = run::wheel_name(lanes_.fleet(), result.unloading.place);
  summary.unloading = {result.unloading.value, result.unloading.time, summary.least_wheel};
  summary.longest_loss = result.longest_loss;
  if (filters_wheels_ && can_filter(scene_.output.wheel_low_pass, wheels)) {
    run::FilteredWheels filtered(scene_.output.wheel_low_pass, scene_.output.unloading_level, plan, wheels);
    for (const double force : until_end(result.wheel_samples, wheels, plan)) filtered.add(force);
    summary.filtered_unloading = filtered.finish(lanes_.fleet());
  }
  return check.evaluate(std::move(summary), result.peaks, static_deflection);
}

}  // namespace traverse::ensemble
