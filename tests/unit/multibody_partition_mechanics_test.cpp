// Which coordinates become independent, which equations are dropped, and which mechanisms are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "traverse/base/error.hpp"
#include "unit/mechanism_helpers.hpp"

namespace traverse::multibody::testing {
namespace {

using Names = std::vector<std::string>;

/// The message with which a mechanism is refused; empty when it is not.
std::string refusal(const MechanismModel& model) {
  try {
    Motion motion(model);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

#define EXPECT_REFUSED(model, ...)                                                                \
  do {                                                                                            \
    const std::string message = refusal(model);                                                   \
    for (const std::string part : {__VA_ARGS__}) EXPECT_TRUE(contains(message, part)) << message; \
  } while (false)

MechanismModel slider() {
  MechanismModel model;
  model.name = "sled";
  model.bodies = {make_body("sled", 2.0, 1.0, 1.0, 0.0)};
  model.joints = {make_joint("guide", JointType::prismatic, ground, 0, 0.0, 0.0, 1.0, 0.0)};
  return model;
}

/// Three parallel cranks of equal length under one coupler: one equation too many, yet it moves.
MechanismModel parallel_cranks(double angle) {
  MechanismModel model;
  model.name = "parallel";
  const Eigen::Vector2d tip(std::cos(angle), std::sin(angle));
  model.bodies = {make_body("coupler", 2.0, 1.0, 1.0 + tip.x(), tip.y())};
  for (int i = 0; i < 3; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    model.joints.push_back(make_distance(name, ground, 0, {i, 0.0}, Eigen::Vector2d(i, 0.0) + tip));
  }
  return model;
}

TEST(Partition, KeepsAnglesAndTheFirstBody) {
  MechanismModel pendulum;
  pendulum.bodies = {make_body("bob", 1.0, 0.1, 0.8, 0.6)};
  pendulum.joints = {make_joint("pin", JointType::revolute, ground, 0, 0.0, 0.0)};
  EXPECT_EQ(Motion(pendulum).mechanism.partition().independent, std::vector<int>{2});

  MechanismModel pair;
  pair.bodies = {make_body("car", 10.0, 1.0, 0.0, 1.0), make_body("axle", 1.0, 0.1, 0.0, 0.0)};
  pair.joints = {make_joint("guide", JointType::prismatic, 0, 1, 0.0, 0.5)};
  EXPECT_EQ(Motion(pair).mechanism.partition().independent, (std::vector<int>{0, 1, 2, 4}));
  EXPECT_EQ(Motion(slider_crank(0.7)).mechanism.partition().independent, std::vector<int>{2});
}

TEST(Partition, WithoutConstraintsEverythingIsIndependent) {
  MechanismModel model;
  model.bodies = {make_body("a", 1.0, 1.0, 0.0, 0.0), make_body("b", 1.0, 1.0, 0.0, 0.0)};
  Motion motion(model);
  EXPECT_EQ(motion.mechanism.freedom(), 6);
  motion.finish();
  EXPECT_EQ(motion.state.B, Eigen::MatrixXd::Identity(6, 6));
  EXPECT_EQ(motion.mechanism.partition_quality(motion.state), 1.0);
  // nothing has to be chosen before the first evaluation
  const Mechanism mechanism(model);
  EXPECT_EQ(mechanism.freedom(), 6);
  EXPECT_EQ(mechanism.make_state().B.cols(), 6);
}

TEST(Partition, DropsRedundantRowsAndStillMovesRight) {
  Motion motion(parallel_cranks(1.2));
  EXPECT_EQ(motion.mechanism.freedom(), 1);
  EXPECT_EQ(motion.mechanism.constraints(), 3);
  EXPECT_EQ(motion.dropped.size(), 1u);
  for (int i = 0; i < 300; ++i) {
    motion.step(1e-3);
    ASSERT_LT(motion.drift(), 1e-13);  // the dropped row too
    ASSERT_NEAR(motion.state.q[2], 0.0, 1e-13);
  }
  EXPECT_TRUE(motion.converged);
  const int dropped = motion.dropped[0][0] - 'a';
  EXPECT_EQ(motion.state.lambda[dropped], 0.0);
}

TEST(Partition, DropsADoubledJointAndADoubledDriver) {
  MechanismModel model = slider();
  model.joints.push_back(make_joint("again", JointType::slot, ground, 0, 2.0, 0.0, 1.0, 0.0));
  EXPECT_EQ(Motion(model).dropped, Names{"again"});

  model = slider();
  model.drivers = {make_driver("one", 0, 0, 1.0, 3.0), make_driver("two", 0, 0, 1.0, 3.0)};
  EXPECT_EQ(Motion(model).dropped, Names{"two"});
}

TEST(Partition, KeepsTheDriverBeforeTheJoint) {
  MechanismModel model = slider();
  model.drivers = {make_driver("level", 0, 2, 0.0, 0.0)};
  Motion motion(model);
  EXPECT_EQ(motion.dropped, Names{"guide"});  // one of its two rows
  EXPECT_EQ(motion.mechanism.freedom(), 1);
  motion.finish();
  EXPECT_NEAR(motion.mechanism.joint_reaction(motion.state, 0).y(), 2.0 * 9.81, 1e-12);
}

TEST(Partition, RefusesContradictingDrivers) {
  MechanismModel model = slider();
  model.drivers = {make_driver("one", 0, 0, 1.0, 3.0), make_driver("two", 0, 0, 1.0, 4.0)};
  EXPECT_REFUSED(model, "sled", "driver 'two' contradicts driver 'one'", "speeds differ by");
  model.drivers = {make_driver("one", 0, 0, 1.0, 3.0), make_driver("two", 0, 0, 1.5, 3.0)};
  EXPECT_REFUSED(model, "driver 'two' contradicts driver 'one'", "off by -0.5 m");
  model.drivers = {make_driver("lift", 0, 1, 0.0, 0.1)};
  EXPECT_REFUSED(model, "joint 'guide' contradicts driver 'lift'", "speeds");
  model.drivers = {{"turn", 0, 2, base::TimeFunction({-1.0, 0.0, 1.0}, {1.0, 0.0, 1.0})}};
  EXPECT_REFUSED(model, "joint 'guide' contradicts driver 'turn'", "accelerations", "rad/s2");
}

TEST(Partition, NoticesADriverThatContradictsLater) {
  // the table rests for 40 s, where the spline's ripples have died out, and leaves the other driver after that
  std::vector<double> times, values;
  for (int i = 0; i <= 50; ++i) {
    times.push_back(i);
    values.push_back(i <= 40 ? 1.0 : 1.0 + 0.1 * (i - 40));
  }
  MechanismModel model = slider();
  model.drivers = {make_driver("one", 0, 0, 1.0, 0.0), {"two", 0, 0, base::TimeFunction(times, values)}};
  Motion motion(model);
  EXPECT_EQ(motion.dropped, Names{"two"});
  EXPECT_TRUE(motion.mechanism.set_positions(motion.state, 10.0, nullptr));
  EXPECT_FALSE(motion.mechanism.set_positions(motion.state, 45.0, nullptr));
  try {
    motion.mechanism.choose_partition(motion.state, 45.0);
    ADD_FAILURE() << "contradiction not seen";
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "driver 'two' contradicts driver 'one': with these met it is off by -0.5 m"))
        << error.what();
  }
}

TEST(Partition, RefusesADeadPoint) {
  EXPECT_REFUSED(parallel_cranks(0.0), "parallel", "dead point", "start from another position");
}

TEST(Partition, ABraceLocksInsteadOfBeingDropped) {
  MechanismModel model = parallel_cranks(1.2);
  model.joints.push_back(make_distance("brace", ground, 0, {0.0, 0.0}, {2.0, 1.0}));
  Motion motion(model);
  EXPECT_EQ(motion.mechanism.freedom(), 0);
  EXPECT_EQ(motion.dropped.size(), 1u);
}

TEST(Partition, MovesBodiesToWhereDriversWantThem) {
  MechanismModel model = slider_crank(0.7);
  model.drivers = {make_driver("motor", 0, 2, 1.3, 0.0)};
  Motion motion(model);
  EXPECT_NEAR(motion.state.q[2], 1.3, 1e-15);
  EXPECT_NEAR(motion.state.q[3], std::cos(1.3) + std::sqrt(9.0 - std::pow(std::sin(1.3), 2)), 1e-13);
  EXPECT_LT(motion.drift(), 1e-13);
  model.drivers = {make_driver("pull", 1, 0, 4.5, 0.0)};  // it reaches to 4
  EXPECT_REFUSED(model, "cannot be put together", "check positions and drivers");
}

TEST(Partition, ProjectsVelocitiesAsAnImpactWould) {
  MechanismModel model;
  model.bodies = {make_body("a", 2.0, 1.0, 0.0, 0.0), make_body("b", 6.0, 1.0, 2.0, 0.0)};
  model.bodies[0].velocity = {4.0, 0.0, 0.0};
  model.joints = {make_joint("weld", JointType::weld, 0, 1, 1.0, 0.0)};
  Motion motion(model);
  motion.finish();
  EXPECT_NEAR(motion.state.qd[0], 1.0, 1e-14);  // 2*4 / (2 + 6)
  EXPECT_NEAR(motion.state.qd[3], 1.0, 1e-14);
  EXPECT_NEAR(motion.state.qd[2], 0.0, 1e-14);
}

TEST(Partition, StatesFollowANewChoice) {
  Mechanism mechanism(slider_crank(0.7));
  MechanismState early = mechanism.make_state();  // before any choice
  MechanismState s = mechanism.make_state();
  mechanism.choose_partition(s, 0.0);
  const double theta = 0.75, rate = 2.0;
  ASSERT_TRUE(mechanism.set_positions(early, 0.0, &theta));
  ASSERT_TRUE(mechanism.set_positions(s, 0.0, &theta));
  mechanism.set_velocities(early, 0.0, &rate);
  mechanism.set_velocities(s, 0.0, &rate);
  EXPECT_LT((early.q - s.q).norm(), 1e-13);
  EXPECT_LT((early.qd - s.qd).norm(), 1e-12);
}

TEST(Partition, QualityFallsWhereTheDependentBlockTurnsSingular) {
  // a rod shorter than the crank: at asin(0.8) it stands upright, and the slider outruns the crank
  MechanismModel model;
  model.name = "short_rod";
  const double theta = 0.3;
  const Eigen::Vector2d pin(std::cos(theta), std::sin(theta));
  const Eigen::Vector2d end(pin.x() + std::sqrt(0.64 - pin.y() * pin.y()), 0.0);
  model.bodies = {make_body("crank", 1.0, 0.1, 0.5 * pin.x(), 0.5 * pin.y(), theta),
                  make_body("slider", 1.0, 0.1, end.x(), end.y())};
  model.joints = {make_joint("bearing", JointType::revolute, ground, 0, 0.0, 0.0),
                  make_joint("guide", JointType::prismatic, ground, 1, 0.0, 0.0, 1.0, 0.0),
                  make_distance("rod", 0, 1, pin, end)};
  Motion motion(model);
  ASSERT_EQ(motion.mechanism.partition().independent, std::vector<int>{2});
  const auto quality = [&](double angle) {
    EXPECT_TRUE(motion.mechanism.set_positions(motion.state, 0.0, &angle));
    const double rate = 1.0;
    motion.mechanism.set_velocities(motion.state, 0.0, &rate);
    return motion.mechanism.partition_quality(motion.state);
  };
  const double limit = std::asin(0.8);
  const double at_choice = quality(theta);
  EXPECT_GT(at_choice, 0.5);
  quality(0.8);
  EXPECT_LT(quality(limit - 1e-5), 0.05 * at_choice);
  // a new choice takes the slider's position, and all is well again
  motion.mechanism.choose_partition(motion.state, 0.0);
  EXPECT_EQ(motion.mechanism.partition().independent, std::vector<int>{3});
  EXPECT_GT(motion.mechanism.partition_quality(motion.state), 0.5);
}

TEST(Partition, UnreachablePositionsAreReported) {
  MechanismModel model = slider_crank(0.7);
  const double start = model.bodies[1].position.x();
  model.drivers = {make_driver("pull", 1, 0, start, 1.0)};
  Motion motion(model);
  ASSERT_EQ(motion.mechanism.freedom(), 0);
  EXPECT_TRUE(motion.mechanism.set_positions(motion.state, 3.9 - start, nullptr));
  EXPECT_FALSE(motion.mechanism.set_positions(motion.state, 4.1 - start, nullptr));  // it reaches to 4
}

TEST(CheckModel, NamesThePartAndTheValue) {
  MechanismModel model = slider();
  model.bodies[0].mass = -3.0;
  EXPECT_REFUSED(model, "vehicle 'sled', body 'sled': mass must be greater than 0, it is -3");
  model = slider();
  model.bodies[0].inertia = 0.0;
  EXPECT_REFUSED(model, "inertia must be greater than 0");
  model = slider();
  model.bodies[0].position.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_REFUSED(model, "position is not a finite number");
  model = slider();
  model.joints[0].axis.setZero();
  EXPECT_REFUSED(model, "joint 'guide': axis must not be zero");
  model = slider();
  model.joints[0].bodies = {0, 0};
  EXPECT_REFUSED(model, "joins a body to itself");
  model.joints[0].bodies = {0, 7};
  EXPECT_REFUSED(model, "there is no body number 7");
  model = slider();
  model.joints = {make_distance("rod", ground, 0, {1.0, 0.0}, {1.0, 0.0})};
  EXPECT_REFUSED(model, "from and to must be different points");
  model = slider();
  model.springs = {make_spring("s", ground, 0, {0.0, 1.0}, {1.0, 0.0}, -1.0)};
  EXPECT_REFUSED(model, "spring 's': stiffness must not be negative, it is -1");
  model.springs[0].stiffness = 1.0;
  model.springs[0].free_length = 1.0;
  model.springs[0].preload = 1.0;
  EXPECT_REFUSED(model, "give free_length or preload, not both");
  model = slider();
  model.drivers = {make_driver("d", ground, 0, 0.0, 0.0)};
  EXPECT_REFUSED(model, "driver 'd': must act on a body, not on the ground");
  model.drivers = {make_driver("d", 0, 3, 0.0, 0.0)};
  EXPECT_REFUSED(model, "coordinate must be 0 (x), 1 (y) or 2 (phi)");
  model = MechanismModel();
  model.name = "empty";
  EXPECT_REFUSED(model, "vehicle 'empty' has no body");
}

}  // namespace
}  // namespace traverse::multibody::testing
