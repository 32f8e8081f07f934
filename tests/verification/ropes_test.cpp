// Scenes with ropes over pulleys and drums against closed forms: static tension, the frequency of a load on several
// falls, hoisting by a drum, bodies that the length of a rope places; and trains by a table of positions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/message.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

/// A load of 2 t on four falls of 8 m, with additional lines of the scene.
std::string crane(const std::string& rope, const std::string& more = "") {
  return "vehicle:\n  crane:\n    bodies: [load]\n    joints: [guide]\n    ropes: [hoist]\n"
         "    load: {mass: 2000, inertia: 100, position: [0, -8]}\n"
         "    guide: {type: prismatic, bodies: [ground, load], point: [0, 0], axis: [0, 1]}\n"
         "    hoist: {bodies: [ground, load, ground, load, ground], points: [0,0, 0,-8, 0,0, 0,-8, 0,0], " +
         rope + "}\n" + more;
}

/// Mean time between upward crossings of the mean, s.
double period_of(const std::vector<double>& time, const std::vector<double>& values) {
  double mean = 0.0, first = 0.0, last = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  int count = -1;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!(values[i - 1] < mean && values[i] >= mean)) continue;
    last = time[i - 1] + (time[i] - time[i - 1]) * (mean - values[i - 1]) / (values[i] - values[i - 1]);
    if (++count == 0) first = last;
  }
  return (last - first) / count;
}

TEST(Ropes, ALoadBouncesOnFourFalls) {
  // n^2 EA/L carries it; from 0.01 m above its equilibrium the motion is a cosine.
  constexpr double EA = 4.0e6, weight = 2000.0 * 9.81;
  const double omega = 4.0 * std::sqrt(EA / 32.0 / 2000.0);
  Results rest = run_yaml(crane("EA: 4.0e6", "ts: {max_time: 0.1}\n"));
  EXPECT_NEAR(rest.column("/vehicles/0/hoist/force").back(), weight / 4.0, 1e-6 * weight);
  EXPECT_NEAR(rest.column("/vehicles/0/load/position", 1).back(), -8.0 - weight / (omega * omega * 2000.0), 1e-9);
  Results run =
      run_yaml(crane("EA: 4.0e6, free_length: 31.96", "scene: {start: given}\nts: {max_time: 4, dt: 1e-3}\n"));
  const double period = period_of(run.time(), run.column("/vehicles/0/load/position", 1));
  EXPECT_NEAR(period, 2.0 * pi / omega * std::sqrt(31.96 / 32.0), 1e-4 * period);
  EXPECT_LT(energy_error(run), 1e-6);
}

TEST(Ropes, TheLengthPlacesWhatHangsOnIt) {
  const std::string rope = "EA: 4.0e6, length: 20, lifts: [load]";
  Results run = run_yaml(crane(rope, "scene: {start: given}\nts: {max_time: 1e-3}\n"));
  EXPECT_NEAR(run.column("/vehicles/0/load/position", 1).front(), -5.0, 1e-12);
  // A hook block with its load by slings, below the trolley of the scene: 8 m of falls instead of 6 m.
  Results block = run_scene("hook_block", {{"scene_start", "given"}, {"ts_max_time", "1e-3"}, {"accuracy", "1e-2"}});
  EXPECT_NEAR(block.column("/vehicles/0/hook/position", 1).front(), -5.6 - 2.0, 0.01);
  EXPECT_NEAR(
      block.column("/vehicles/0/load/position", 1).front() - block.column("/vehicles/0/hook/position", 1).front(), -3.0,
      1e-12);
}

TEST(Ropes, AHookBlockSharesItsWeight) {
  Results run = run_scene("hook_block", {{"ts_max_time", "0.1"}});
  EXPECT_NEAR(run.column("/vehicles/0/hoist/force").front(), 1.0e4 * 9.81 / 4.0, 3e-3 * 1.0e4 * 9.81 / 4.0)
      << "the falls are slightly inclined";
}

// The sheave drives both ropes; the car follows it by the stretch of its rope, whose unstretched length decreases.
TEST(Ropes, ASheaveHoistsACar) {
  Results run = run_scene("elevator", {{"ts_max_time", "20"}});
  constexpr double EA = 2.1e7, weight = 1600.0 * 9.81;
  const std::vector<double> car = run.column("/vehicles/0/car/position", 1),
                            force = run.column("/vehicles/0/car_ropes/force"),
                            other = run.column("/vehicles/0/counterweight_ropes/force");
  EXPECT_NEAR(force.front(), weight, 1e-6 * weight);
  EXPECT_NEAR(other.front(), 1300.0 * 9.81, 1e-6 * weight);
  EXPECT_NEAR(car.front(), -39.7 * weight / EA, 1e-8);
  EXPECT_NEAR(car.back(), 30.0 - 9.7 * weight / EA, 2e-5);
  const double greatest = *std::max_element(force.begin(), force.end());
  EXPECT_NEAR(greatest, 1600.0 * (9.81 + 1.0), 0.02 * weight) << "m (g + a), the jerk excites little";
  EXPECT_LT(energy_error(run), 1e-5);
}

TEST(Ropes, ATableOfPositionsIsThatOfItsSpeeds) {
  const TemporaryFolder folder;
  std::string places = "# t (s), x (m)\n", speeds = "# t (s), v (m/s)\n0,10\n4,26\n";
  for (int i = 0; i <= 16; ++i) {
    const double t = 0.25 * i, x = 10.0 * t + 2.0 * t * t;
    places += text(t) + "," + text(x - 5.0) + "\n";
  }
  const std::string scene =
      "beam: {spans: [20, 20], EI: 1e10, mass: 1e4, damping_ratios: 0.02, elements_per_span: 8}\n"
      "vehicle: {quarter: {file: " +
      source_folder() +
      "/options/vehicles/crane_trolley.yml}}\n"
      "train: {vehicles: quarter}\nts: {dt: 2e-3, max_time: 3}\noutput: {probes: 10}\n";
  Results by_place = run_yaml(scene, {{"train_position_file", folder.write("x.csv", places)}});
  Results by_speed = run_yaml(scene, {{"train_speed_file", folder.write("v.csv", speeds)}, {"train_positions", "-6"}});
  EXPECT_LT(relative_difference(by_place("/probes/deflection"), by_speed("/probes/deflection")), 1e-6)
      << "a constant acceleration";
}

TEST(Ropes, Refusals) {
  const auto refused = [](const std::string& rope) { return message_of([&] { run_yaml(crane(rope)); }); };
  EXPECT_EQ(refused("EA: 1e6, stiffness: 1e6").find("vehicle_crane_hoist_EA"), 0U);
  EXPECT_NE(refused("damping: 1").find("a rope needs a stiffness or EA"), std::string::npos);
  EXPECT_NE(refused("EA: 1e6, length: 0.5").find("lifts"), std::string::npos);
  EXPECT_NE(refused("stiffness: 1e3, preload: 1e6").find("stretches the rope by less"), std::string::npos);
  EXPECT_NE(refused("EA: 1e6, drum: load").find("drum_radius"), std::string::npos);
}

}  // namespace
}  // namespace traverse::test
