// The least and the greatest of the wheels' forces, step by step.
#include <gtest/gtest.h>

#include <cmath>

#include "run/wheel_unloading.hpp"
#include "support/scene_run.hpp"

namespace traverse::run {
namespace {

// The error falls with the sixth power of the step.
TEST(WheelExtremes, LieBetweenSteps) {
  for (const double dt : {0.05, 0.02, 0.01}) {
    WheelExtremes extremes(2, {});
    for (int i = 0; i * dt <= 0.6; ++i) {
      const double t = i * dt;
      extremes.add(0, t, 0.0, 100.0);
      extremes.add(1, t, 0.0, 100.0 - 50.0 * std::sin(10.0 * t + 0.1));
    }
    extremes.finish();
    const double allowed = 50.0 * std::pow(10.0 * dt, 6) / 200.0;
    EXPECT_NEAR(extremes.of_all().least.value, 50.0, allowed) << dt;
    EXPECT_EQ(extremes.of_all().least.place, 1u);
    EXPECT_NEAR(10.0 * extremes.of_all().least.time + 0.1, std::acos(-1.0) / 2.0, std::pow(10.0 * dt, 2));
    EXPECT_NEAR(extremes.of_all().greatest.value, 150.0, allowed) << dt;
    const double at_start = 100.0 - 50.0 * std::sin(0.1);
    EXPECT_NEAR(extremes.of_all().unloading.value, 1.0 - 50.0 / at_start, allowed / at_start) << dt;
    EXPECT_EQ(extremes.of_all().unloading.place, 1u);
  }
}

// At the corner of a track, and where a contact is lost or met, no parabola goes below what was seen.
TEST(WheelExtremes, AtCornersAndInFlight) {
  WheelExtremes corner(1, {3.0}), flight(1, {}), impact(1, {});
  const double force[] = {10.0, 8.0, 2.0, 7.0, 9.0};
  for (int i = 0; i < 5; ++i) corner.add(0, i, 1.0 + i, force[i]);
  EXPECT_EQ(corner.of_all().least.value, 2.0);
  const double lost[] = {10.0, 5.0, 0.0, 0.0, 0.0, 6.0, 9.0};
  for (int i = 0; i < 7; ++i) flight.add(0, i, 0.0, lost[i]);
  EXPECT_EQ(flight.of_all().least.value, 0.0);
  EXPECT_EQ(flight.of_all().least.time, 2.0);
  const double time[] = {0.0, 1.0, 1.000001, 2.0}, jump[] = {5.0, 5.0, 90.0, 80.0};
  for (int i = 0; i < 4; ++i) impact.add(0, time[i], 0.0, jump[i]);
  EXPECT_EQ(impact.of_all().greatest.value, 90.0);
}

// A mass on a linear wheel that starts 1.5 times as deep as its weight presses it: N = m g (1 + cos(w t)/2).
TEST(WheelExtremes, OfAMassOnASpring) {
  const std::string text = R"(
vehicle:
  mass:
    bodies: [body]
    drivers: [level]
    wheels: [wheel]
    body: {mass: 1000.0, inertia: 1.0, position: [0.0, 0.445285]}
    level: {body: body, coordinate: phi}
    wheel: {body: body, radius: 0.46, law: linear, stiffness: 1.0e6}
train: {vehicles: mass, speed: 10.0}
scene: {start: given}
ts: {max_time: 0.2, dt: 0.013}
)";
  test::Results run = test::run_yaml(text);
  const double weight = 9810.0, omega = std::sqrt(1000.0);
  EXPECT_NEAR(run.attribute("/summary", "least_wheel_force"), 0.5 * weight, 5e-4 * weight);
  EXPECT_NEAR(run.attribute("/summary", "greatest_wheel_force"), 1.5 * weight, 5e-4 * weight);
  const double half_turns = run.attribute("/summary", "least_wheel_force_time") * omega / std::acos(-1.0);
  EXPECT_NEAR(std::remainder(half_turns - 1.0, 2.0), 0.0, 5e-3);
}

}  // namespace
}  // namespace traverse::run
