// A run as an object: its result has the values that its file would have, and observers see and stop it.
#include "run/simulation.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene_helpers.hpp"
#include "support/scene_run.hpp"

namespace traverse::run {
namespace {

const std::string bridge =
    "beam: {spans: [25.0, 30.0, 25.0], EI: 8.33e9, mass: 2303.0, elements_per_span: 8, damping_ratios: 0.02}\n" +
    scene::vehicle_yaml + "train: {vehicles: car, speed: 30}\noutput: {probes: [12.5, 40.0], interval: 0.01}\n" +
    "ts: {dt: 0.002, max_time: 1.0}\nmodel: {vehicles: full}\n";

/// A simulation with the objects that must outlive it.
struct OneRun {
  scene::Scene scene = scene::scene_of(bridge);
  std::vector<std::string> notes;
  SharedBeam shared{PETSC_COMM_SELF, scene, notes};
  Simulation simulation;

  explicit OneRun(const Wants& wants) : simulation((shared.set_up(scene, false, notes), scene), shared, wants, notes) {}
};

TEST(Simulation, HasTheResultOfItsFile) {
  const test::Results file = test::run_yaml(bridge);
  OneRun run({.stored = true});
  run.simulation.run({});
  const Result result = run.simulation.result();
  EXPECT_EQ(result.summary.deflection.value, file.attribute("/summary", "deflection"));
  EXPECT_EQ(result.summary.acceleration.value, file.attribute("/summary", "acceleration"));
  EXPECT_EQ(result.summary.greatest_wheel_force, file.attribute("/summary", "greatest_wheel_force"));
  EXPECT_EQ(result.summary.energy_residual, file.attribute("/summary", "energy_residual"));
  EXPECT_EQ(result.peaks.largest(deflection).value, result.summary.deflection.value);
  EXPECT_TRUE(result.shape.has_value());
}

TEST(Simulation, GivesWithoutWantsThePeaksAlone) {
  OneRun all({.stored = true}), peaks({});
  all.simulation.run({});
  peaks.simulation.run({});
  const Result result = peaks.simulation.result();
  EXPECT_EQ(result.peaks.largest(moment).value, all.simulation.result().peaks.largest(moment).value);
  EXPECT_FALSE(result.shape.has_value());
  EXPECT_TRUE(result.datasets.empty());
}

TEST(Simulation, GoesOnWhereAnObserverStoppedIt) {
  OneRun whole({}), stopped({});
  int samples = 0, steps = 0;
  ObserverBy counter([&](const integrate::Instant& now) { samples += integrate::is_stored(now.purpose) ? 1 : 0; },
                     [&](double, long) {
                       ++steps;
                       return true;
                     });
  whole.simulation.run({&counter});
  EXPECT_EQ(samples, 101);
  EXPECT_EQ(steps, whole.simulation.passage().steps());
  double last = 0.0;
  ObserverBy until_half({}, [&](double t, long) {
    last = t;
    return t < 0.5;
  });
  stopped.simulation.run({&until_half});
  EXPECT_NEAR(last, 0.5, 0.002);
  stopped.simulation.run({});
  EXPECT_EQ(stopped.simulation.result().peaks.largest(acceleration).value,
            whole.simulation.result().peaks.largest(acceleration).value);
}

}  // namespace
}  // namespace traverse::run
