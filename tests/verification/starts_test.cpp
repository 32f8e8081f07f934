// Runs start with vehicles that follow the surface under their wheels: positions of rest, and the velocities of that.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

/// A rigid bar without damping on a spring under each end.
constexpr double bar = 8.0, bar_mass = 1.6e4, spring = 2.0e7;  // m, kg, N/m
const std::string rigid_bar = R"(
beam: {spans: 8.0, EI: 1.0e13, mass: 2.0e3, damping_ratios: 0.0, elements_per_span: 4}
support: {types: [free, free]}
foundation: {vertical: {x: [0.0, 8.0], k: 2.0e7}}
ts: {dt: 1.0e-3}
output: {interval: 1.0e-3, probes: [0.0, 3.0, 8.0]}
)";

/// Its deflection at x under a force and a moment (counter-clockwise) that come onto the left end at t = 0 with the
/// speed v.
double bar_deflection(double x, double t, double v, double force, double moment) {
  const double heave = std::sqrt(2.0 * spring / bar_mass), turning_stiffness = 0.5 * spring * bar * bar;
  const double pitch = std::sqrt(turning_stiffness / (bar_mass * bar * bar / 12.0));
  const double down = force / (2.0 * spring) * (1.0 - std::cos(heave * t));
  const double arm = v * t - 0.5 * bar + 0.5 * bar * std::cos(pitch * t) - v / pitch * std::sin(pitch * t);
  const double turn = (force * arm - moment * (1.0 - std::cos(pitch * t))) / turning_stiffness;  // clockwise
  return -down - turn * (x - 0.5 * bar);
}

// What arrives at the first instant is not on the bridge before: it begins undeflected. Seen before: the equilibrium
// under the force, by elements and by modes.
TEST(Starts, WhatArrivesAtTheFirstInstantBeginsOutside) {
  const double v = 20.0, end = bar / v, force = 1.0e5;
  struct Case {
    std::string load;
    bool leftwards;
    double moment;
    Values options;
  };
  const std::vector<Case> cases = {
      {"load: {forces: 1.0e5, speed: 20.0}\n", false, 0.0, {}},
      {"load: {forces: 1.0e5, speed: 20.0}\n", false, 0.0, {{"model_modes", "2"}}},
      {"load: {forces: 1.0e5, positions: 8.0, speed: -20.0}\n", true, 0.0, {}},
      {"load: {forces: 1.0e5, moments: 3.0e5, speed: 20.0}\n", false, 3.0e5, {}},
  };
  for (const Case& one : cases) {
    Results run = run_yaml(rigid_bar + one.load + "scene: {tail: 0.0}\n", one.options);
    const std::vector<double> t = run.time();
    const std::vector<double>& x = run("/probes/x");
    for (std::size_t p = 0; p < x.size(); ++p) {
      const std::vector<double> deflection = run.column("/probes/deflection", p);
      for (std::size_t i = 0; i < t.size() && t[i] < end; ++i)
        ASSERT_NEAR(deflection[i], bar_deflection(one.leftwards ? bar - x[p] : x[p], t[i], v, force, one.moment), 5e-6)
            << one.load << "x = " << x[p] << ", t = " << t[i];
    }
  }
}

TEST(Starts, SweepsBeginOutsideToo) {
  Results sweep = run_yaml(rigid_bar + "load: {forces: 1.0e5}\nsweep: {speed: [20.0, 20.0, 1.0]}\nscene: {tail: 0.0}\n",
                           {{"model_modes", "2"}});
  const std::array x = {0.0, 3.0, 8.0};
  for (std::size_t p = 0; p < x.size(); ++p) {
    double exact = 0.0;
    for (double t = 0.0; t <= bar / 20.0; t += 1e-5)
      exact = std::max(exact, std::abs(bar_deflection(x[p], t, 20.0, 1.0e5, 0.0)));
    EXPECT_NEAR(sweep("/sweep/peak_deflection")[p], exact, 2e-3 * exact) << x[p];
  }
}

// A force at rest on the end stands there: F/k.
TEST(Starts, WhatRestsOnAnEndStandsThere) {
  for (const double place : {0.0, 8.0}) {
    Results run = run_yaml(rigid_bar, {{"ts_max_time", "0.1"},
                                       {"load_forces", "1e5"},
                                       {"load_positions", fmt::format("{}", place)},
                                       {"load_speed", "0"}});
    for (const double deflection : run.column("/probes/deflection", place == 0.0 ? 0 : 2))
      ASSERT_NEAR(deflection, -1.0e5 / spring, 1e-6);
  }
}

}  // namespace
}  // namespace traverse::test
