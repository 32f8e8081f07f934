// Mechanisms in motion against exact solutions and conservation laws. p and p' are integrated by Runge-Kutta here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "unit/mechanism_helpers.hpp"

namespace traverse::multibody::testing {
namespace {

constexpr double pi = std::numbers::pi;

MechanismModel pendulum(double angle) {
  // mass 2, inertia 0.3 about the centre of mass, 1.5 m from the pin
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
  const double quarter = std::comp_ellint_1(std::sin(amplitude / 2.0)) / omega0;
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

TEST(FreeBody, FallsAlongItsParabola) {
  MechanismModel model;
  model.name = "stone";
  model.bodies = {make_body("stone", 2.0, 0.1, 1.0, 2.0)};
  model.bodies[0].velocity = {3.0, 4.0, 5.0};
  Motion motion(model);
  ASSERT_EQ(motion.mechanism.freedom(), 3);
  for (int i = 0; i < 10; ++i) motion.step(0.1);
  motion.finish();
  EXPECT_NEAR(motion.state.q[0], 1.0 + 3.0, 1e-14);
  EXPECT_NEAR(motion.state.q[1], 2.0 + 4.0 - 0.5 * 9.81, 1e-13);
  EXPECT_NEAR(motion.state.q[2], 5.0, 1e-14);
  EXPECT_NEAR(motion.state.qd[1], 4.0 - 9.81, 1e-13);
}

TEST(TwoBodiesAndASpring, KeepTheirMomentum) {
  MechanismModel model;
  model.name = "pair";
  model.gravity = 0.0;
  model.bodies = {make_body("a", 2.0, 0.5, 0.0, 0.0), make_body("b", 3.0, 0.7, 2.0, 1.0)};
  model.bodies[0].velocity = {1.0, -2.0, 3.0};
  model.bodies[1].velocity = {0.5, 1.0, -1.0};
  model.springs = {make_spring("s", 0, 1, {0.3, 0.2}, {1.8, 0.7}, 40.0, 0.8)};
  model.torsion_springs = {{"t", {0, 1}, 5.0, 0.2, std::nullopt}};
  Motion motion(model);
  const auto momentum = [&] {
    const MechanismState& s = motion.state;
    const Eigen::VectorXd P = motion.mechanism.mass_diagonal().cwiseProduct(s.qd);
    const double angular = P[2] + P[5] + s.q[0] * P[1] - s.q[1] * P[0] + s.q[3] * P[4] - s.q[4] * P[3];
    return Eigen::Vector3d(P[0] + P[3], P[1] + P[4], angular);
  };
  motion.finish();
  const Eigen::Vector3d before = momentum();
  const double energy = motion.total_energy();
  for (int i = 0; i < 3000; ++i) motion.step(1e-3);
  motion.finish();
  EXPECT_LT((momentum().head<2>() - before.head<2>()).norm(), 1e-12);
  EXPECT_NEAR(momentum().z(), before.z(), 1e-9);  // Runge-Kutta keeps linear invariants only
  EXPECT_LT(motion.total_energy(), energy - 0.1);
}

/// The energy lost or won over a second with n steps.
double energy_error(const MechanismModel& model, int n) {
  Motion motion(model);
  motion.finish();
  const double start = motion.total_energy();
  for (int i = 0; i < n; ++i) {
    motion.step(1.0 / n);
    EXPECT_LT(motion.drift(), 1e-13);
  }
  motion.finish();
  EXPECT_TRUE(motion.converged);
  return std::abs(motion.total_energy() - start);
}

TEST(SliderCrank, KeepsItsEnergyAtTheOrderOfTheIntegrator) {
  for (const bool distance : {false, true}) {
    MechanismModel model = slider_crank(1.0, distance);
    model.springs = {make_spring("s", ground, 1, {6.0, 0.0}, model.bodies[1].position.head<2>(), 300.0)};
    const double coarse = energy_error(model, 100), fine = energy_error(model, 200);
    EXPECT_GT(std::log2(coarse / fine), 3.7);
    EXPECT_LT(fine, 1e-3);
    EXPECT_LT(energy_error(model, 3200), 1e-8);
  }
}

TEST(FourBar, KeepsItsEnergyAtTheOrderOfTheIntegrator) {
  MechanismModel model = four_bar();
  model.springs = {make_spring("s", ground, 2, {7.0, 3.0}, {5.0, 3.0}, 100.0)};
  model.torsion_springs = {{"t", {0, 1}, 8.0, 0.0, -0.5}};
  const double coarse = energy_error(model, 100), fine = energy_error(model, 200);
  EXPECT_GT(std::log2(coarse / fine), 3.7);
  EXPECT_LT(energy_error(model, 3200), 1e-8);
}

TEST(SliderCrank, TurnsThroughItsDeadPointsWithTheCrankIndependent) {
  MechanismModel model = slider_crank(0.3);
  model.gravity = 0.0;
  model.bodies[0].velocity.z() = 100.0;  // made to fit by the start's projection
  Motion motion(model);
  ASSERT_EQ(motion.mechanism.partition().independent, std::vector<int>{2});
  double least_quality = 1.0;
  for (int i = 0; i < 2000; ++i) {
    motion.step(5e-4);
    least_quality = std::min(least_quality, motion.mechanism.partition_quality(motion.state));
    const double theta = motion.state.q[2];
    const double x = crank_length * std::cos(theta) +
                     std::sqrt(rod_length * rod_length - std::pow(crank_length * std::sin(theta), 2));
    ASSERT_NEAR(motion.state.q[3], x, 1e-13);
    ASSERT_LT(motion.drift(), 1e-13);
  }
  EXPECT_TRUE(motion.converged);
  EXPECT_GT(motion.state.q[2], 4.0 * pi);
  EXPECT_GT(least_quality, 0.2);
}

TEST(SliderCrank, DrivenAtConstantSpeedTheDriverDoesTheWork) {
  const auto error = [](int n) {
    MechanismModel model = slider_crank(0.5);
    model.drivers = {make_driver("motor", 0, 2, 0.5, 6.0)};
    model.springs = {make_spring("s", ground, 1, {7.0, 0.0}, model.bodies[1].position.head<2>(), 100.0, 5.0)};
    for (Body& b : model.bodies) b.velocity.setZero();
    Motion motion(model);
    EXPECT_EQ(motion.mechanism.freedom(), 0);
    EXPECT_EQ(motion.mechanism.partition_quality(motion.state), 1.0);
    // Simpson's rule over the powers
    const double h = 1.0 / n;
    double work = 0.0, first = 0.0, last = 0.0;
    for (int i = 0; i <= n; ++i) {
      motion.time = i * h;
      motion.finish();
      const MechanismEnergy e = motion.mechanism.energy(motion.state);
      const double weight = i == 0 || i == n ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
      work += weight * h / 3.0 * (e.work - e.dissipation);
      if (i == 0) first = motion.total_energy();
      last = motion.total_energy();
    }
    EXPECT_TRUE(motion.converged);
    return std::abs(last - first - work);
  };
  EXPECT_GT(std::log2(error(100) / error(200)), 3.7);
  EXPECT_LT(error(1000), 1e-6);
}

TEST(QuickReturn, RotatingSlotIsFollowedThroughFullTurns) {
  // a crank whose pin slides in an arm about another pivot within the crank's circle: the arm turns fully, so the
  // slot's normal takes all directions and the order of elimination wears out again and again
  MechanismModel model;
  model.name = "quick_return";
  const double r = 1.0, e = 0.4;
  model.bodies = {make_body("crank", 1.0, 0.2, 0.5 * r, 0.0), make_body("arm", 2.0, 0.5, -e + 0.7, 0.0)};
  model.joints = {make_joint("bearing", JointType::revolute, ground, 0, 0.0, 0.0),
                  make_joint("pivot", JointType::revolute, ground, 1, -e, 0.0),
                  make_joint("pin", JointType::slot, 1, 0, r, 0.0, 1.0, 0.0)};
  model.drivers = {make_driver("motor", 0, 2, 0.0, 2.0 * pi)};
  Motion motion(model);
  double turn = 0.0;
  for (int i = 1; i <= 700; ++i) {
    motion.time = 0.01 * i;
    motion.finish();
    ASSERT_TRUE(motion.converged) << motion.time;
    ASSERT_LT(motion.drift(), 1e-13);
    const double theta = motion.state.q[2];
    const double arm = std::atan2(r * std::sin(theta), r * std::cos(theta) + e);
    turn = arm + 2.0 * pi * std::round((theta - arm) / (2.0 * pi));
    ASSERT_NEAR(motion.state.q[5], turn, 1e-12);
  }
  EXPECT_NEAR(motion.state.q[5], 14.0 * pi, 1e-11);
}

TEST(DoublePendulum, CarriesOnInNewCoordinates) {
  MechanismModel model;
  model.name = "double_pendulum";
  model.bodies = {make_body("upper", 1.0, 0.1, 0.5, 0.0), make_body("lower", 1.0, 0.1, 1.5, 0.0)};
  model.joints = {make_joint("top", JointType::revolute, ground, 0, 0.0, 0.0),
                  make_joint("middle", JointType::revolute, 0, 1, 1.0, 0.0)};
  Motion once(model), often(model);
  once.finish();
  const double start = once.total_energy();
  for (int i = 0; i < 2000; ++i) {
    once.step(5e-4);
    often.step(5e-4);
    if (i % 100 == 0) often.repartition();
  }
  once.finish();
  often.finish();
  EXPECT_NEAR(once.total_energy(), start, 1e-9);
  EXPECT_LT((once.state.q - often.state.q).norm(), 1e-11);
  EXPECT_LT((once.state.lambda - often.state.lambda).norm(), 1e-8);
}

TEST(Actuator, TorqueAcceleratesTheRotorAndReactsOnTheFrame) {
  MechanismModel model;
  model.name = "motor";
  model.gravity = 0.0;
  model.bodies = {make_body("rotor", 1.0, 0.5, 0.0, 0.0), make_body("frame", 4.0, 2.0, 0.0, 0.0)};
  model.joints = {make_joint("bearing", JointType::revolute, 1, 0, 0.0, 0.0)};
  Actuator torque;
  torque.body = 0;
  torque.reaction_body = 1;
  torque.action[2] = base::TimeFunction(3.0, 0.0);
  model.actuators = {torque};
  Motion motion(model);
  for (int i = 0; i < 10; ++i) motion.step(0.1);
  motion.finish();
  EXPECT_NEAR(motion.state.qd[2], 3.0 / 0.5, 1e-13);
  EXPECT_NEAR(motion.state.qd[5], -3.0 / 2.0, 1e-13);
  const MechanismEnergy e = motion.mechanism.energy(motion.state);
  EXPECT_NEAR(e.work, 3.0 * (6.0 + 1.5), 1e-12);
}

}  // namespace
}  // namespace traverse::multibody::testing
