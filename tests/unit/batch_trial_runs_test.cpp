// Trial passages side by side: low-passed accelerations are those of a run by itself, and keeping them changes nothing
// else.
#include "error_control/batch_trial_runs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene_helpers.hpp"
#include "support/folders.hpp"
#include "support/scene_run.hpp"

namespace traverse::error_control {
namespace {

// The speed is the lowest of its class, so that places a step apart are instants a step apart.
const std::string coaches =
    "beam: {spans: [30.0, 24.0], EI: 1.5e11, mass: 2.0e4, damping_ratios: 0.02}\n"
    "support: {types: [pinned, roller, roller]}\n"
    "vehicle: {coach: {file: " +
    source_folder() +
    "/options/vehicles/velaro.yml}}\n"
    "train: {vehicles: coach*2, speed: 64.0}\n";

scene::NumericalModel model_with(double step) {
  scene::NumericalModel model;
  model.elements = 40;
  model.method = "esdirk4";
  model.step = step;
  model.vehicles = scene::VehicleModel::linear;
  return model;
}

engine::BatchResult trial(bool filtered, double step, double distance) {
  scene::Scene scene = scene::scene_of(coaches);
  scene.sweep.emplace();
  scene.sweep->speeds = {64.0};
  scene.output.low_pass_requested = filtered;
  scene.output.low_pass = 30.0;
  BatchTrialRuns trials(scene, {{64.0}}, distance);
  return trials.run(model_with(step)).front();
}

TEST(BatchTrialRuns, LowPassedAccelerationsAreThoseOfTheRunItself) {
  const double step = 5e-4;
  const test::Results alone = test::run_yaml(coaches, {{"model_modes", "0"},
                                                       {"model_vehicles", "linear"},
                                                       {"beam_elements_per_span", "40"},
                                                       {"ts_dt", "5e-4"},
                                                       {"step_probes", "true"},
                                                       {"output_lowpass", "30"}});
  const double truth = std::abs(alone.attribute("/summary", "acceleration_lowpass"));
  const engine::BatchResult lane = trial(true, step, 64.0 * alone.attribute("/summary", "end_time"));
  ASSERT_EQ(lane.failure, engine::none);
  ASSERT_EQ(lane.peaks.size(), 2U);
  const double found = std::max(lane.peaks[0].low_passed.value, lane.peaks[1].low_passed.value);
  EXPECT_LT(alone.attribute("/summary", "acceleration_lowpass_time"), alone.attribute("/summary", "end_time") - 0.1);
  EXPECT_NEAR(found, truth, 1e-4 * truth);
  const double raw = std::abs(alone.attribute("/summary", "acceleration"));
  EXPECT_GT(std::abs(raw - truth), 1e-2 * truth);  // the filter takes something away
}

TEST(BatchTrialRuns, KeepingAccelerationsChangesNothingElse) {
  for (const double step : {1e-3, 5e-4}) {
    const engine::BatchResult with = trial(true, step, 110.0), without = trial(false, step, 110.0);
    EXPECT_EQ(without.peaks[0].low_passed.value, 0.0);
    EXPECT_GT(with.peaks[0].low_passed.value, 0.0);
    for (std::size_t p = 0; p < 2; ++p) {
      EXPECT_NEAR(with.peaks[p].deflection.value, without.peaks[p].deflection.value,
                  1e-5 * without.peaks[p].deflection.value);
      EXPECT_NEAR(with.peaks[p].moment.value, without.peaks[p].moment.value, 1e-4 * without.peaks[p].moment.value);
      EXPECT_NEAR(with.peaks[p].acceleration.value, without.peaks[p].acceleration.value,
                  3e-2 * without.peaks[p].acceleration.value);
    }
  }
}

}  // namespace
}  // namespace traverse::error_control
