// Two wheels on bearings that are geared together.
#include <gtest/gtest.h>

#include "unit/mechanism_helpers.hpp"

namespace traverse::multibody::testing {
namespace {

constexpr double first_inertia = 0.8, second_inertia = 0.3, moment = 7.0;

MechanismModel geared(double ratio) {
  MechanismModel model;
  model.name = "gear";
  model.bodies = {make_body("first", 2.0, first_inertia, 0.0, 0.0), make_body("second", 1.0, second_inertia, 1.5, 0.0)};
  model.joints = {make_joint("a", JointType::revolute, ground, 0, 0.0, 0.0),
                  make_joint("b", JointType::revolute, ground, 1, 1.5, 0.0),
                  make_joint("gear", JointType::named("gear"), 0, 1, 0.0, 0.0)};
  model.joints[2].numbers[0] = ratio;
  Actuator drive;
  drive.name = "drive";
  drive.action[2] = base::TimeFunction(moment, 0.0);
  model.actuators = {drive};
  return model;
}

// (J1 + i^2 J2) phi1'' = moment, phi2 = -i phi1; the second wheel is turned by -i J2 phi1''.
TEST(Gear, TurnsLikeTheReducedInertia) {
  for (const double ratio : {2.5, -0.4}) {
    Motion motion(geared(ratio));
    EXPECT_TRUE(motion.dropped.empty());
    const double acceleration = moment / (first_inertia + ratio * ratio * second_inertia);
    const int steps = 50;
    for (int i = 0; i < steps; ++i) motion.step(0.02);
    motion.finish();
    const MechanismState& s = motion.state;
    EXPECT_TRUE(motion.converged);
    EXPECT_NEAR(s.qdd[2], acceleration, 1e-12 * acceleration);
    EXPECT_NEAR(s.q[2], 0.5 * acceleration, 1e-12 * acceleration);  // at t = 1 s
    EXPECT_NEAR(s.q[5], -ratio * s.q[2], 1e-12 * acceleration);
    const Eigen::Vector3d reaction = motion.mechanism.joint_reaction(s, 2);
    EXPECT_NEAR(reaction.z(), -ratio * second_inertia * acceleration, 1e-12 * moment);
    EXPECT_EQ(reaction.head<2>().norm(), 0.0);
    EXPECT_NEAR(motion.mechanism.energy(s).kinetic, moment * s.q[2], 1e-11 * moment * s.q[2]);
  }
}

}  // namespace
}  // namespace traverse::multibody::testing
