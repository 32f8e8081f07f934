// Trains whose speed is prescribed: what slows them down acts on the track, at the running surface under their wheels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/record.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr double mass = 2.0e4 + 2.0 * 1.5e3;  // kg, of the vehicle below

const std::string two_axles = R"(
vehicle:
  car:
    bodies:  [body, front, rear]
    joints:  [front_guide, rear_guide]
    springs: [front_spring, rear_spring]
    wheels:  [front_wheel, rear_wheel]
    body:  {mass: 2.0e4, inertia: 1.0e5, position: [0.0, 2.0]}
    front: {mass: 1.5e3, inertia: 1.0, position: [2.0, 0.46]}
    rear:  {mass: 1.5e3, inertia: 1.0, position: [-3.0, 0.46]}
    front_guide: {type: prismatic, bodies: [body, front], point: [2.0, 0.46], axis: [0.0, 1.0]}
    rear_guide:  {type: prismatic, bodies: [body, rear], point: [-3.0, 0.46], axis: [0.0, 1.0]}
    front_spring: {bodies: [body, front], from: [2.0, 2.0], to: [2.0, 0.46], stiffness: 2.0e6, damping: 4.0e4}
    rear_spring:  {bodies: [body, rear], from: [-3.0, 2.0], to: [-3.0, 0.46], stiffness: 2.0e6, damping: 4.0e4}
    front_wheel: {body: front, radius: 0.46, law: linear, stiffness: 1.0e9}
    rear_wheel:  {body: rear, radius: 0.46, law: linear, stiffness: 1.0e9}
)";

const std::string deck = R"(
beam: {spans: 30.0, EI: 2.0e10, EA: 1.0e10, mass: 5000.0, elements_per_span: 6}
train: {vehicles: car, positions: 6.0}
ts: {dt: 1.0e-3, max_time: 2.0}
output: {interval: 0.01, probes: [6.0, 15.0, 24.0]}
)" + two_axles;

/// From 10 m/s, by 2 m/s2 from 0.2 s on.
constexpr const char* brakes = "0,10\n0.2,10\n2.2,6\n";

}  // namespace

// A deck that a very soft spring alone holds along x takes what the train loses, less what goes into the spring. It
// does not bend, so that wheels push nothing along it by its slope.
TEST(BrakingForce, ImpulseIsTheChangeOfMomentum) {
  const TemporaryFolder folder;
  Results run = run_yaml(deck, {{"train_speed_file", folder.write("speed.csv", "0,10\n0.2,10\n0.7,7\n")},
                                {"beam_EI", "2e16"},
                                {"beam_EA", "1e11"},
                                {"beam_rayleigh", "0,0.004"},
                                {"support_types", "roller,roller"},
                                {"foundation_longitudinal_x", "0"},
                                {"foundation_longitudinal_k", "1"}});
  const std::vector<double> u = run.column("/probes/axial_displacement", 1), t = run.time();
  const std::size_t after = 100, last = u.size() - 1;
  ASSERT_NEAR(t[after], 1.0, 1e-9);
  double into_spring = 0.0, mean = 0.0;  // N s, of k = 1 N/m; its mean from `after` on
  for (std::size_t i = 1; i <= last; ++i) {
    const double before = into_spring, h = t[i] - t[i - 1];
    into_spring += 0.5 * h * (u[i - 1] + u[i]);
    if (i > after) mean += 0.5 * h * (before + into_spring) / (t[last] - t[after]);
  }
  const double momentum = 5000.0 * 30.0 * (u[last] - u[after]) / (t[last] - t[after]) + mean;
  const double error = std::abs(momentum / (mass * 3.0) - 1.0);
  record("error", error);
  EXPECT_LT(error, 1e-9);
  EXPECT_LT(energy_error(run), 1e-8);
}

// Long after the brakes have come on, on a deck that does not bend and swings no more along x; in balance at every
// instant.
TEST(BrakingForce, BearingTakesMassTimesAcceleration) {
  const TemporaryFolder folder;
  const Values held = {{"train_speed_file", folder.write("speed.csv", brakes)},
                       {"support_types", "pinned,roller"},
                       {"beam_EI", "2e16"},
                       {"beam_EA", "1e13"},
                       {"beam_rayleigh", "0,3e-4"}};
  Results run = run_yaml(deck, held);
  const std::vector<double> load = run.column("/balance/load", 0), residual = run.column("/balance/residual", 0);
  EXPECT_NEAR(load[10], 0.0, 1e-3);
  const double force = mass * 2.0;
  double load_error = 0.0;
  for (std::size_t i = 21; i < load.size(); ++i) load_error = std::max(load_error, std::abs(load[i] / force - 1.0));
  const double bearing_error = std::abs(run("/supports/reaction").rbegin()[5] / -force - 1.0);
  record("load_error", load_error);
  record("bearing_error", bearing_error);
  record("balance_error", std::abs(peak(residual).first) / force);
  EXPECT_LT(load_error, 1e-8);
  EXPECT_LT(bearing_error, 1e-7);
  EXPECT_LT(std::abs(peak(residual).first) / force, 1e-9);
}

// The running surface 2 m above the axis: the couple lifts one end of the deck and presses the other.
TEST(BrakingForce, ActsAtTheRunningSurface) {
  const TemporaryFolder folder;
  const Values held = {{"train_speed_file", folder.write("speed.csv", brakes)},
                       {"support_types", "pinned,roller"},
                       {"beam_rayleigh", "0.5,0.01"},
                       {"train_positions", "8.0"}};
  Results axis = run_yaml(deck, held);
  Results surface = run_yaml(deck, held + Values{{"beam_surface_height", "2.0"}});
  const std::vector<double>& low = axis("/supports/reaction");
  const std::vector<double>& high = surface("/supports/reaction");
  const double couple = mass * 2.0 * 2.0 / 30.0;
  // Of the last sample: fy of the left and the right end. The train's wheels press elsewhere as the deck bends.
  const double left = high.rbegin()[4] - low.rbegin()[4], right = high.rbegin()[1] - low.rbegin()[1];
  record("couple_error", std::max(std::abs(left / -couple - 1.0), std::abs(right / couple - 1.0)));
  EXPECT_NEAR(left, -couple, 0.02 * couple);
  EXPECT_NEAR(right, couple, 0.02 * couple);
}

TEST(BrakingForce, ToTheLeftIsTheMirrorImage) {
  const TemporaryFolder folder;
  Results right = run_yaml(deck, {{"train_speed_file", folder.write("right.csv", brakes)},
                                  {"support_types", "pinned,roller"},
                                  {"beam_surface_height", "1.0"}});
  Results left = run_yaml(deck, {{"train_speed_file", folder.write("left.csv", "0,-10\n0.2,-10\n2.2,-6\n")},
                                 {"support_types", "roller,pinned"},
                                 {"train_positions", "24.0"},
                                 {"output_probes", "24,15,6"},
                                 {"beam_surface_height", "1.0"}});
  std::vector<double> mirrored = left("/probes/axial_displacement");
  for (double& u : mirrored) u = -u;
  const double along = relative_difference(mirrored, right("/probes/axial_displacement"));
  const double across = relative_difference(left("/probes/deflection"), right("/probes/deflection"));
  record("error", std::max(along, across));
  EXPECT_LT(std::max(along, across), 1e-9);
}

// The rail of a layered track takes the force, and hands it on to deck and ground.
TEST(BrakingForce, GoesIntoTheRail) {
  const TemporaryFolder folder;
  Results run = run_yaml(deck, {{"train_speed_file", folder.write("speed.csv", brakes)},
                                {"support_types", "pinned,roller"},
                                {"track_rail_EI", "1.3e7"},
                                {"track_rail_EA", "3.2e9"},
                                {"track_rail_mass", "120"},
                                {"track_spacing", "0.6"},
                                {"track_pad_k", "1e8"},
                                {"track_pad_c", "1e5"},
                                {"track_longitudinal_k", "1e7"},
                                {"track_longitudinal_c", "1e4"},
                                {"track_approach", "12"},
                                {"ts_max_time", "0.5"}});
  const std::vector<double> load = run.column("/balance/load", 0), residual = run.column("/balance/residual", 0);
  record("balance_error", std::abs(peak(residual).first) / (mass * 2.0));
  EXPECT_NEAR(load.back(), mass * 2.0, 0.01 * mass * 2.0);  // wheels push along x by the rail's slope, too
  EXPECT_LT(std::abs(peak(residual).first), 1e-9 * mass * 2.0);
  EXPECT_GT(peak(run("/rail/axial_force")).first, 0.0);
}

// Wheels that rub put their forces on the track by friction, and no others.
TEST(BrakingForce, WheelsThatRubDoItThemselves) {
  const TemporaryFolder folder;
  Results run = run_yaml(deck, {{"train_speed_file", folder.write("speed.csv", brakes)},
                                {"support_types", "pinned,roller"},
                                {"vehicle_car_rear_wheel_friction", "0.1"},
                                {"vehicle_car_rear_wheel_transition_speed", "0.01"}});
  Results plain = run_yaml(deck, {{"train_speed", "10"},
                                  {"support_types", "pinned,roller"},
                                  {"vehicle_car_rear_wheel_friction", "0.1"},
                                  {"vehicle_car_rear_wheel_transition_speed", "0.01"}});
  EXPECT_NEAR(run.column("/balance/load", 0).back(), plain.column("/balance/load", 0).back(), 0.05 * mass);
}

}  // namespace traverse::test
