// Mechanisms in motion against exact solutions and conservation laws. p and p' are integrated by Runge-Kutta here.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "unit/mechanism_helpers.hpp"

namespace traverse::multibody::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// Complete elliptic integral of the first kind, modulus k, by the arithmetic-geometric mean.
double complete_elliptic(double k) { return std::comp_ellint_1(k); }

MechanismModel pendulum(double angle) {
  // a point-like rod: mass 2, inertia 0.3 about the centre of mass, 1.5 m from the pin
  MechanismModel model;
  model.name = "pendulum";
  model.bodies = {make_body("bob", 2.0, 0.3, 1.5 * std::sin(angle), -1.5 * std::cos(angle))};
  model.joints = {make_joint("pin", JointType::revolute, ground, 0, 0.0, 0.0)};
  return model;
}

TEST(Pendulum, PeriodAndPinForceAtLargeAmplitude) {
  const double amplitude = 2.5;
  Motion motion(pendulum(amplitude));
  const double inertia = 0.3 + 2.0 * 1.5 * 1.5;
  const double omega0 = std::sqrt(2.0 * 9.81 * 1.5 / inertia);
  const double quarter = complete_elliptic(std::sin(amplitude / 2.0)) / omega0;
  const int steps = 4000;
  for (int i = 0; i < steps; ++i) motion.step(quarter / steps);
  motion.finish();
  ASSERT_TRUE(motion.converged);
  // a quarter of the period after release it hangs straight down
  const double speed = 2.0 * omega0 * std::sin(amplitude / 2.0);
  EXPECT_NEAR(motion.state.q[0], 0.0, 1e-8);
  EXPECT_NEAR(motion.state.q[1], -1.5, 1e-8);
  EXPECT_NEAR(motion.state.q[2], -amplitude, 1e-8);
  EXPECT_NEAR(motion.state.qd[2], -speed, 1e-8);
  const Eigen::Vector3d pin = motion.mechanism.joint_reaction(motion.state, 0);
  EXPECT_NEAR(pin.x(), 0.0, 1e-6);
  EXPECT_NEAR(pin.y(), 2.0 * (9.81 + 1.5 * speed * speed), 1e-6);
  EXPECT_EQ(pin.z(), 0.0);
}

}  // namespace
}  // namespace traverse::multibody::testing
