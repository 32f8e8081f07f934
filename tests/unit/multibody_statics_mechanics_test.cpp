// Reactions of joints and drivers at rest against statics.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/mechanism_helpers.hpp"

namespace traverse::multibody::testing {
namespace {

constexpr double weight = 2.0 * 9.81;

MechanismModel bar(double x, double y) {
  MechanismModel model;
  model.name = "bar";
  model.bodies = {make_body("bar", 2.0, 0.5, x, y)};
  return model;
}

void expect_reaction(const Motion& motion, int joint, double fx, double fy, double moment) {
  const Eigen::Vector3d reaction = motion.mechanism.joint_reaction(motion.state, joint);
  EXPECT_NEAR(reaction.x(), fx, 1e-12);
  EXPECT_NEAR(reaction.y(), fy, 1e-12);
  EXPECT_NEAR(reaction.z(), moment, 1e-12);
}

TEST(Reaction, HangingBody) {
  MechanismModel model = bar(0.0, -1.0);
  model.joints = {make_joint("pin", JointType::revolute, ground, 0, 0.0, 0.0)};
  Motion motion(model);
  motion.finish();
  expect_reaction(motion, 0, 0.0, weight, 0.0);
  EXPECT_LT(motion.state.qdd.norm(), 1e-13);
  // on the ground as the second body the same with the other sign
  model.joints[0].bodies = {0, ground};
  Motion other(model);
  other.finish();
  expect_reaction(other, 0, 0.0, -weight, 0.0);
}

TEST(Reaction, Cantilever) {
  MechanismModel model = bar(1.5, 0.0);
  model.joints = {make_joint("wall", JointType::weld, ground, 0, 0.0, 0.0)};
  Motion motion(model);
  motion.finish();
  EXPECT_EQ(motion.mechanism.freedom(), 0);
  expect_reaction(motion, 0, 0.0, weight, 1.5 * weight);
}

TEST(Reaction, PrismaticGuideCarriesForceAndMoment) {
  MechanismModel model = bar(1.5, 0.3);
  model.joints = {make_joint("guide", JointType::prismatic, ground, 0, 0.5, 0.0, 1.0, 0.0)};
  Motion motion(model);
  motion.finish();
  EXPECT_EQ(motion.mechanism.freedom(), 1);
  expect_reaction(motion, 0, 0.0, weight, 1.0 * weight);
}

TEST(Reaction, SlotCarriesOnlyItsNormalForce) {
  // a bar on a pin at its left and a slot along x at its right end
  MechanismModel model = bar(0.5, 0.0);
  model.joints = {make_joint("pin", JointType::revolute, ground, 0, 0.0, 0.0),
                  make_joint("slot", JointType::slot, ground, 0, 2.0, 0.0, 1.0, 0.0)};
  Motion motion(model);
  motion.finish();
  EXPECT_EQ(motion.mechanism.freedom(), 0);
  expect_reaction(motion, 0, 0.0, 0.75 * weight, 0.0);
  expect_reaction(motion, 1, 0.0, 0.25 * weight, 0.0);
}

TEST(Reaction, TwoRopesAtAnAngle) {
  MechanismModel model = bar(0.0, 0.0);
  model.joints = {make_distance("left", ground, 0, {-3.0, 4.0}, {0.0, 0.0}),
                  make_distance("right", ground, 0, {3.0, 4.0}, {0.0, 0.0})};
  Motion motion(model);
  motion.finish();
  const double across = 0.5 * weight * 3.0 / 4.0;
  expect_reaction(motion, 0, -across, 0.5 * weight, 0.0);
  expect_reaction(motion, 1, across, 0.5 * weight, 0.0);
  EXPECT_NEAR(std::abs(motion.state.lambda[0]), 0.5 * weight * 5.0 / 4.0, 1e-12);  // the rope's force
}

TEST(Reaction, ChainAddsUpItsWeights) {
  MechanismModel model = bar(0.0, -1.0);
  model.bodies.push_back(make_body("lower", 3.0, 0.5, 0.0, -3.0));
  model.joints = {make_joint("top", JointType::revolute, ground, 0, 0.0, 0.0),
                  make_joint("middle", JointType::revolute, 0, 1, 0.0, -2.0)};
  Motion motion(model);
  motion.finish();
  expect_reaction(motion, 0, 0.0, 5.0 * 9.81, 0.0);
  expect_reaction(motion, 1, 0.0, 3.0 * 9.81, 0.0);
}

TEST(Reaction, DriverHoldsAPendulumAside) {
  MechanismModel model = bar(1.5, 0.0);
  model.joints = {make_joint("pin", JointType::revolute, ground, 0, 0.0, 0.0)};
  model.drivers = {make_driver("hold", 0, 2, 0.0, 0.0)};
  Motion motion(model);
  motion.finish();
  EXPECT_NEAR(motion.mechanism.driver_force(motion.state, 0), 1.5 * weight, 1e-12);
  EXPECT_EQ(motion.mechanism.energy(motion.state).work, 0.0);
}

TEST(Reaction, ExternalForceGoesIntoTheJoint) {
  MechanismModel model = bar(0.0, -1.0);
  model.joints = {make_joint("pin", JointType::revolute, ground, 0, 0.0, 0.0)};
  Motion motion(model);
  motion.Q << 7.0, 5.0, 7.0 * -1.0;  // a force (7, 5) through the pin
  motion.finish();
  EXPECT_LT(motion.state.qdd.norm(), 1e-13);
  expect_reaction(motion, 0, -7.0, weight - 5.0, 0.0);
}

TEST(Reaction, CarriesTheInertiaOfADrivenBody) {
  // x of a body follows a table; its second derivative at t = 0.5 times the mass is the driver's force
  MechanismModel model = bar(0.0, 0.0);
  const base::TimeFunction table({0.0, 1.0, 2.0}, {0.0, 1.0, 0.0});
  model.joints = {make_joint("guide", JointType::prismatic, ground, 0, 0.0, 0.0, 1.0, 0.0)};
  model.drivers = {{"drive", 0, 0, table}};
  Motion motion(model);
  motion.time = 0.5;
  motion.finish();
  EXPECT_NEAR(motion.mechanism.driver_force(motion.state, 0), 2.0 * table.acceleration(0.5), 1e-13);
  EXPECT_NEAR(motion.mechanism.energy(motion.state).work, 2.0 * table.acceleration(0.5) * table.rate(0.5), 1e-13);
}

}  // namespace
}  // namespace traverse::multibody::testing
