// Runs start with vehicles that follow the surface under their wheels: positions of rest, and the velocities of that.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr double g = 9.81;

const std::string mass_on_wheel = R"(
vehicle:
  mass:
    bodies: [axle]
    wheels: [wheel]
    drivers: [level]
    axle: {mass: 11.0e3, inertia: 1.0e3, position: [0.0, 0.46]}
    level: {body: axle, coordinate: phi}
    wheel: {body: axle, radius: 0.46, law: hertz, stiffness: 3.64e10}
)";

const std::string coach = R"(
vehicle:
  coach:
    bodies: [car, front, rear]
    springs: [front_spring, rear_spring]
    wheels: [front_wheel, rear_wheel]
    joints: [front_guide, rear_guide]
    car: {mass: 20.0e3, inertia: 4.0e5, position: [0.0, 1.5]}
    front: {mass: 1.5e3, inertia: 100.0, position: [6.0, 0.46]}
    rear: {mass: 1.5e3, inertia: 100.0, position: [-6.0, 0.46]}
    front_guide: {type: prismatic, bodies: [car, front], point: [6.0, 0.46], axis: [0.0, 1.0]}
    rear_guide: {type: prismatic, bodies: [car, rear], point: [-6.0, 0.46], axis: [0.0, 1.0]}
    front_spring: {bodies: [car, front], from: [6.0, 1.5], to: [6.0, 0.46], stiffness: 1.0e6, damping: 2.0e4}
    rear_spring: {bodies: [car, rear], from: [-6.0, 1.5], to: [-6.0, 0.46], stiffness: 1.0e6, damping: 2.0e4}
    front_wheel: {body: front, radius: 0.46, law: hertz, stiffness: 3.64e10}
    rear_wheel: {body: rear, radius: 0.46, law: hertz, stiffness: 3.64e10}
)";

double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }
double greatest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

// Before, it was hit by the ramp: 0 to 297 kN, and 25 losses. Along the ramp it stays in balance.
TEST(Starts, WheelForceOnARampIsConstant) {
  const TemporaryFolder folder;
  const std::string ramp = folder.write("ramp.csv", "-200,-1\n200,1\n");
  Results run = run_yaml(mass_on_wheel + R"(
train: {vehicles: mass, speed: 40.0, positions: -20.0}
ts: {max_time: 0.3, dt: 1.0e-3}
output: {interval: 0.001}
)",
                         {{"track_profile", ramp}});
  const double exact = 11.0e3 * g * std::hypot(1.0, 1.0 / 200.0);  // normal to the ramp
  const std::vector<double>& force = run("/vehicles/0/wheel/normal_force");
  EXPECT_NEAR(least(force), exact, 1e-6 * exact);
  EXPECT_NEAR(greatest(force), exact, 1e-6 * exact);
  EXPECT_EQ(run.attribute("/summary", "contact_losses"), 0.0);
}

// Of the beam deflected under it: F b x (L^2 - b^2 - x^2)/(6 EI L). The bridge is at rest, and the force hardly
// changes.
TEST(Starts, WheelFollowsTheDeflectedBeam) {
  Results run = run_yaml("beam: {spans: 20.0, EI: 2.0e9, mass: 5.0e3, elements_per_span: 16}\n" + mass_on_wheel + R"(
train: {vehicles: mass, speed: 40.0, positions: 5.0}
ts: {max_time: 0.02, dt: 5.0e-5}
output: {interval: 0.0005}
)");
  const double F = 11.0e3 * g, L = 20.0, b = 15.0, x = 5.0, EI = 2.0e9, v = 40.0;
  const double slope = -F * b * (L * L - b * b - 3.0 * x * x) / (6.0 * EI * L);
  const std::vector<double> rate = run.column("/vehicles/0/axle/velocity", 1);
  EXPECT_NEAR(rate.front(), v * slope, 1e-4 * std::abs(v * slope));
  const std::vector<double>& force = run("/vehicles/0/wheel/normal_force");
  EXPECT_NEAR(force.front(), F, 1e-5 * F);
  // To follow the deflection's curvature M/EI takes m v^2 M/EI, 3.3 % of the weight, about which it swings.
  EXPECT_GT(least(force), 0.92 * F) << "0.77 before";
  EXPECT_LT(greatest(force), 1.08 * F);
}

// A coach whose wheels begin on a long bump, 6 m on either side of its top: they go up and down with it, and the car
// turns with them.
TEST(Starts, CoachTurnsWithTheSurface) {
  Results run = run_yaml(coach + R"(
train: {vehicles: coach, speed: 40.0, positions: 0.0}
track: {profile: bump, bump: {start: -150.0, length: 300.0, height: 0.1}}
ts: {max_time: 0.1, dt: 1.0e-3}
output: {interval: 0.001}
)");
  const double pi = std::acos(-1.0), slope = -0.1 * pi / 300.0 * std::sin(pi * 6.0 / 150.0);
  for (const auto& [body, sign] : {std::pair("front", 1.0), std::pair("rear", -1.0)})
    EXPECT_NEAR(run.column(fmt::format("/vehicles/0/{}/velocity", body), 1).front(), 40.0 * sign * slope, 1e-6);
  EXPECT_NEAR(run.column("/vehicles/0/car/velocity", 1).front(), 0.0, 1e-6);
  // The car's weight, 1.04 m above the axles, turns it further by as much as m g h/(2 k a^2).
  const double turn = 40.0 * slope / 6.0, further = 20.0e3 * g * 1.04 / (2.0 * 1.0e6 * 36.0);
  EXPECT_NEAR(run.column("/vehicles/0/car/velocity", 2).front(), turn, further * std::abs(turn));
}

}  // namespace
}  // namespace traverse::test
