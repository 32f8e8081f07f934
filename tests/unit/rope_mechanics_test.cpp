// Ropes over several points: derivatives, falls that share one tension, a slack rope, winches and drums with their
// energy.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/message.hpp"
#include "unit/mechanism_helpers.hpp"

namespace traverse::multibody::testing {
namespace {

using Eigen::Vector2d;
using test::message_of;

/// A rope from body 0 over the ground and body 1 to a drum, body 2, that body 1 carries.
MechanismModel over_pulleys(bool by_rigidity) {
  MechanismModel model;
  model.name = "ropes";
  model.bodies = {make_body("a", 2.0, 0.5, 0.1, 0.2, 0.3), make_body("b", 1.0, 0.2, 1.0, 1.1, -0.2),
                  make_body("drum", 0.7, 0.3, 1.2, 1.3, 0.1)};
  Rope rope;
  rope.name = "rope";
  rope.bodies = {0, ground, 1, ground, 1};
  rope.points = {Vector2d(0.3, 0.4), Vector2d(0.5, 2.0), Vector2d(0.9, 1.0), Vector2d(1.4, 2.2), Vector2d(1.3, 1.2)};
  rope.damping = 2.0;
  rope.drum = 2;
  rope.drum_radius = 0.25;
  rope.preload = 60.0;
  rope.winding = base::TimeFunction(0.0, -0.2);
  (by_rigidity ? rope.axial_rigidity : rope.stiffness) = by_rigidity ? 500.0 : 120.0;
  model.ropes = {rope};
  return model;
}

TEST(Rope, ForceDerivativesMatchDifferences) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-0.05, 0.05);
  for (const bool by_rigidity : {false, true}) {
    Motion motion(over_pulleys(by_rigidity));
    for (int trial = 0; trial < 5; ++trial) {
      Eigen::VectorXd q = motion.p, qd(9);
      for (int i = 0; i < 9; ++i) {
        q[i] += number(random);
        qd[i] = number(random);
      }
      const auto force = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& rate) {
        motion.mechanism.set_positions(motion.state, 0.4, at.data());
        motion.mechanism.set_velocities(motion.state, 0.4, rate.data());
        motion.mechanism.compute_forces(motion.state);
        return motion.state.g;
      };
      force(q, qd);
      ASSERT_GT(motion.mechanism.rope_tension(motion.state, 0), 1.0);
      Eigen::MatrixXd g_q, g_qd;  // without joints B is the identity
      motion.mechanism.multiply_tangent(motion.state, 1.0, 0.0, 0.0, g_q);
      motion.mechanism.multiply_tangent(motion.state, 0.0, 1.0, 0.0, g_qd);
      for (int j = 0; j < 9; ++j) {
        const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(9, j);
        EXPECT_LT((g_q.col(j) - (force(q + step, qd) - force(q - step, qd)) / 2e-6).norm(), 1e-6 * g_q.norm());
        EXPECT_LT((g_qd.col(j) - (force(q, qd + step) - force(q, qd - step)) / 2e-6).norm(), 1e-6 * g_qd.norm());
      }
    }
  }
}

/// A load that hangs on `falls` vertical falls of one rope between the ground at y = 10 and itself at y = 0.
MechanismModel hook_block(int falls, double EA) {
  MechanismModel model;
  model.name = "crane";
  model.bodies = {make_body("load", 1000.0, 1.0, 0.0, 0.0)};
  Rope rope;
  rope.name = "rope";
  for (int i = 0; i <= falls; ++i) {
    const bool above = i % 2 == 0;
    rope.bodies.push_back(above ? ground : 0);
    rope.points.emplace_back(0.0, above ? 10.0 : 0.0);
  }
  rope.axial_rigidity = EA;
  model.ropes = {rope};
  return model;
}

TEST(Rope, FallsShareOneTension) {
  constexpr double EA = 4.0e6, weight = 9810.0;
  for (const int falls : {1, 2, 3, 4, 6}) {
    MechanismModel model = hook_block(falls, EA);
    const double tension = weight / falls;
    model.ropes[0].preload = tension;
    Motion motion(model);
    motion.finish();
    EXPECT_NEAR(motion.mechanism.rope_tension(motion.state, 0), tension, 1e-9 * tension);
    EXPECT_LT(motion.state.qdd.norm(), 1e-10) << "it is in equilibrium";
    Eigen::MatrixXd g_q;
    motion.mechanism.multiply_tangent(motion.state, 1.0, 0.0, 0.0, g_q);
    const double unstretched = 10.0 * falls / (1.0 + tension / EA);
    EXPECT_NEAR(-g_q(1, 1), falls * falls * EA / unstretched, 1e-9 * falls * EA) << "n^2 EA/L";
  }
}

// m y'' = m g - EA (y/L - 1) with L = L0 - v t: y - L (1 + m g/EA) = sqrt(s) (A J1(z) + B Y1(z)), s = L, z = 2 sqrt(k
// s).
TEST(Rope, StiffensAsAWinchShortensIt) {
  constexpr double EA = 2.0e5, mass = 1000.0, g = 9.81, speed = 0.5, stretch = 1.0 + mass * g / EA,
                   length = 10.0 / stretch;
  MechanismModel model = hook_block(1, EA);
  model.ropes[0].free_length = length;
  model.ropes[0].winding = base::TimeFunction(0.0, -speed);
  Motion motion(model);  // in equilibrium but for the speed of the winch
  const double k = EA / (mass * speed * speed);
  const auto terms = [&](double s) {
    const double z = 2.0 * std::sqrt(k * s), root = std::sqrt(s);
    return Eigen::Matrix2d{
        {root * std::cyl_bessel_j(1.0, z), root * std::cyl_neumann(1.0, z)},  // and their derivatives over s
        {std::sqrt(k) * std::cyl_bessel_j(0.0, z), std::sqrt(k) * std::cyl_neumann(0.0, z)}};
  };
  const Vector2d factors = terms(length).inverse() * Vector2d(0.0, -stretch);
  const double h = 3e-4;
  double worst = 0.0, start_energy = 0.0, work = 0.0;
  motion.finish();
  start_energy = motion.total_energy();
  for (int i = 1; i <= 40000; ++i) {  // to 4 m of the rope
    work += 0.5 * h * motion.mechanism.energy(motion.state).work;
    motion.step(h);
    motion.finish();
    work += 0.5 * h * motion.mechanism.energy(motion.state).work;
    const double s = length - speed * motion.time;
    const double below = s * stretch + (terms(s).row(0) * factors).value();
    ASSERT_GT(motion.mechanism.rope_tension(motion.state, 0), 0.0) << motion.time;
    worst = std::max(worst, std::abs(10.0 - motion.state.q[1] - below));
  }
  EXPECT_LT(worst, 1e-8);
  EXPECT_NEAR(motion.total_energy() - start_energy, work, 1e-6 * work);
}

// Two loads on a sheave that turns freely: (m1 - m2) g/(m1 + m2 + J/R^2), apart from the vibration of the ropes.
TEST(Rope, DrumsTakeUpWhatTheyTurn) {
  constexpr double radius = 0.4, g = 9.81;
  MechanismModel model;
  model.name = "lift";
  model.bodies = {make_body("car", 900.0, 1.0, -radius, 0.0), make_body("weight", 700.0, 1.0, radius, 0.0),
                  make_body("sheave", 50.0, 8.0, 0.0, 20.0)};
  model.joints = {make_joint("bearing", JointType::revolute, ground, 2, 0.0, 20.0)};
  for (const int side : {0, 1}) {
    Rope rope;
    rope.name = side == 0 ? "left" : "right";
    const double x = side == 0 ? -radius : radius;
    rope.bodies = {side, ground};
    rope.points = {Vector2d(x, 0.0), Vector2d(x, 20.0)};
    rope.axial_rigidity = 4.0e7;
    rope.preload = (side == 0 ? 900.0 : 700.0) * g;
    rope.drum = 2;
    rope.drum_radius = x;
    model.ropes.push_back(rope);
  }
  Motion motion(model);
  motion.finish();
  const double energy = motion.total_energy();
  double work = 0.0;
  const double h = 2e-4;
  for (int i = 0; i < 10000; ++i) {
    work += 0.5 * h * motion.mechanism.energy(motion.state).work;
    motion.step(h);
    motion.finish();
    work += 0.5 * h * motion.mechanism.energy(motion.state).work;
  }
  const double acceleration = 200.0 * g / (1600.0 + 8.0 / (radius * radius)), way = 0.5 * acceleration * 4.0;
  EXPECT_NEAR(-motion.state.q[1], way, 3e-3 * way) << "the car falls";
  EXPECT_NEAR(motion.state.q[4], way, 3e-3 * way);
  EXPECT_NEAR(motion.state.q[8], way / radius, 3e-3 * way / radius) << "the sheave turns counter-clockwise";
  EXPECT_NEAR(motion.total_energy(), energy + work, 1e-6 * std::abs(energy));
}

TEST(Rope, PullsOnly) {
  MechanismModel model = hook_block(2, 1.0e6);
  model.ropes[0].free_length = 21.0;
  Motion motion(model);
  motion.finish();
  EXPECT_EQ(motion.mechanism.rope_tension(motion.state, 0), 0.0);
  EXPECT_DOUBLE_EQ(motion.state.qdd[1], -9.81);
}

TEST(Rope, Refusals) {
  const auto refused = [](auto change) {
    MechanismModel model = hook_block(2, 1.0e6);
    change(model.ropes[0]);
    return message_of([&] { Mechanism{model}; });
  };
  const auto names = [](const std::string& message, const char* words) {
    return message.find(words) != std::string::npos;
  };
  EXPECT_TRUE(names(refused([](Rope& r) { r.stiffness = 1.0; }), "either a stiffness or an axial rigidity"));
  EXPECT_TRUE(names(refused([](Rope& r) { r.points.pop_back(); }), "at least two points, and a body for each"));
  EXPECT_TRUE(names(refused([](Rope& r) { r.bodies = {ground, ground, ground}; }), "moves no body"));
  EXPECT_TRUE(names(refused([](Rope& r) { r.free_length = 0.0; }), "unstretched length must be greater than 0"));
  EXPECT_TRUE(names(refused([](Rope& r) { r.bodies.back() = r.drum = 0; }), "the body that carries the drum"));
}

}  // namespace
}  // namespace traverse::multibody::testing
