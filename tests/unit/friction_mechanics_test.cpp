// Dry friction in sliding joints: exact motions, the coupled normal forces, derivatives against differences, jamming.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "support/message.hpp"
#include "traverse/base/error.hpp"
#include "unit/mechanism_helpers.hpp"

namespace traverse::multibody::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// A block on the ground's x axis.
MechanismModel block(double mass, const SlidingFriction& friction, double speed) {
  MechanismModel model;
  model.name = "block";
  model.bodies = {make_body("block", mass, 0.1, 0.0, 0.0)};
  model.bodies[0].velocity.x() = speed;
  model.joints = {make_joint("slide", JointType::prismatic, ground, 0, 0.0, 0.0, 1.0, 0.0)};
  model.joints[0].friction = friction;
  return model;
}

TEST(SlidingFriction, ABlockComesToRestAsTheHyperbolicSineDecays) {
  // v' = -a tanh(v/v0), a = mu g + F/m: sinh(v/v0) falls by e^(-a t/v0)
  const double mass = 2.0, mu = 0.3, force = 1.5, v0 = 0.05, start = 0.8;
  Motion motion(block(mass, {mu, force, v0}, start));
  const double a = mu * 9.81 + force / mass, h = 2.5e-4;
  double worst = 0.0;
  for (int i = 1; i <= 1600; ++i) {
    motion.step(h);
    const double exact = v0 * std::asinh(std::sinh(start / v0) * std::exp(-a * motion.time / v0));
    worst = std::max(worst, std::abs(motion.pd[0] - exact));
  }
  motion.finish();
  RecordProperty("error", std::to_string(worst / start));
  EXPECT_LT(worst, 1e-9 * start);
  EXPECT_LT(motion.pd[0], 1e-3 * v0) << "it has come to rest";
  EXPECT_NEAR(motion.p[0], start * start / (2.0 * a), 1e-2 * start * start / (2.0 * a));
}

TEST(SlidingFriction, ASpringLosesFourTimesTheForceOverTheStiffnessACycle) {
  // constant force: half a period takes 2 F/k off the amplitude
  const double mass = 1.0, k = 400.0, force = 4.0, amplitude = 0.2, period = 2.0 * std::numbers::pi / 20.0;
  MechanismModel model = block(mass, {0.0, force, 1e-3}, 0.0);
  model.bodies[0].position.x() = amplitude;
  model.joints[0].point.x() = amplitude;
  model.springs = {make_spring("s", ground, 0, {-1.0, 0.0}, {amplitude, 0.0}, k)};
  model.springs[0].free_length = 1.0;
  Motion motion(model);
  const int steps = 40000;  // the transition takes v0/(omega^2 amplitude), 12 us
  for (int cycle = 1; cycle <= 2; ++cycle) {
    for (int i = 0; i < steps; ++i) motion.step(period / steps);
    // at the turn the speed is nought, in the friction's transition: a Coulomb force there is 1.5 us late
    EXPECT_NEAR(amplitude - motion.p[0], 4.0 * cycle * force / k, 1e-3 * 4.0 * force / k) << cycle;
  }
}

TEST(SlidingFriction, AGuideRubsByItsSideLoad) {
  // a vertical guide with a spring from the side: mu |lambda| against the fall, whichever side it is pulled to
  const double mass = 3.0, pull = 40.0, mu = 0.25, v0 = 1e-3;
  for (const double side : {-1.0, 1.0}) {
    MechanismModel model;
    model.name = "guide";
    model.bodies = {make_body("block", mass, 0.1, 0.0, 0.0)};
    model.bodies[0].velocity.y() = -0.5;
    model.joints = {make_joint("guide", JointType::prismatic, ground, 0, 0.0, 0.0, 0.0, 1.0)};
    model.joints[0].friction = {mu, 0.0, v0};
    Actuator actuator;
    actuator.action = {base::TimeFunction(side * pull, 0.0), base::TimeFunction(0.0, 0.0),
                       base::TimeFunction(0.0, 0.0)};
    model.actuators = {actuator};
    Motion motion(model);
    motion.finish();
    EXPECT_NEAR(motion.state.qdd[1], mu * pull / mass - 9.81, 1e-13 * 9.81);
    const Eigen::Vector3d reaction = motion.mechanism.joint_reaction(motion.state, 0);
    EXPECT_NEAR(reaction.x(), -side * pull, 1e-12 * pull);
    EXPECT_NEAR(reaction.y(), mu * pull, 1e-12 * pull);
    EXPECT_NEAR(motion.mechanism.energy(motion.state).dissipation, mu * pull * 0.5, 1e-12 * pull);
  }
}

/// A slider-crank and a sleeve that slides and turns on its rod: two joints with a coefficient, one with a force too.
MechanismModel rubbing_crank() {
  MechanismModel model = slider_crank(0.7);
  model.bodies[0].velocity.z() = 3.0;
  model.joints[1].friction = {0.4, 3.0, 2.0};
  const Eigen::Vector2d at = model.bodies[2].position.head<2>();
  model.bodies.push_back(make_body("sleeve", 0.8, 0.05, at.x() + 0.2, at.y() + 0.3));
  const double phi = model.bodies[2].position.z();
  model.joints.push_back(
      make_joint("sleeve", JointType::slot, 2, 3, at.x() + 0.1, at.y(), std::cos(phi), std::sin(phi)));
  model.joints.back().friction = {0.6, 0.0, 1.0};
  model.springs = {make_spring("s", ground, 3, {1.0, 2.0}, {at.x() + 0.2, at.y() + 0.3}, 30.0, 1.0)};
  model.springs[0].free_length = 0.5;
  return model;
}

/// In motion, away from where it was made.
Motion moving_crank() {
  Motion motion(rubbing_crank());
  for (int i = 0; i < 40; ++i) motion.step(5e-3);
  motion.Q = VectorXd::LinSpaced(motion.mechanism.coordinates(), -4.0, 9.0);
  motion.finish();
  return motion;
}

TEST(SlidingFriction, NormalForcesAndFrictionAgree) {
  const Motion motion = moving_crank();
  const MechanismState& s = motion.state;
  VectorXd missed = motion.mechanism.mass_diagonal().cwiseProduct(s.qdd) - s.g - motion.Q;
  missed += s.Phi_q.transpose() * s.lambda;
  const MechanismModel& model = motion.mechanism.model();
  int k = 0;
  double power = 0.0;
  for (std::size_t j = 0, row = 0; j < model.joints.size();
       row += static_cast<std::size_t>(model.joints[j].type->rows), ++j) {
    const SlidingFriction& law = model.joints[j].friction;
    if (!law.acts()) continue;
    const double lambda = s.lambda[static_cast<int>(row)], v = s.friction.speed[k];
    const double force = -(law.coefficient * std::abs(lambda) + law.force) * std::tanh(v / law.transition_speed);
    EXPECT_NEAR(s.friction.force[k], force, 1e-13 * std::abs(lambda));
    EXPECT_NEAR(s.friction.normal_force[k], lambda, 1e-12 * std::abs(lambda));
    EXPECT_GT(std::abs(force), 0.5);
    missed -= force * s.friction.A.col(k);
    power += force * v;
    ++k;
  }
  ASSERT_EQ(k, 2);
  EXPECT_LT(missed.norm(), 1e-12 * s.lambda.norm());
  EXPECT_LT((s.Phi_q * s.qdd - s.gamma).norm(), 1e-12 * s.gamma.norm());
  double damped = 0.0;
  for (const Spring& spring : model.springs) damped += spring.damping;
  EXPECT_GT(damped, 0.0) << "so that friction is not all of it";
  EXPECT_LT(power, -1.0);
  EXPECT_GT(motion.mechanism.energy(s).dissipation, -power);
}

TEST(SlidingFriction, IsTheSameInAMotionThatIsGiven) {
  Motion motion = moving_crank();
  VectorXd pdd(motion.mechanism.freedom());
  ASSERT_TRUE(motion.evaluate(motion.time, pdd.data()));
  const VectorXd lambda = motion.state.lambda, force = motion.state.friction.force, qdd = motion.state.qdd;
  motion.state.friction.normal_force *= -1.0;  // whatever signs it starts from
  motion.mechanism.recover(motion.state, motion.Q, pdd.data());
  EXPECT_FALSE(motion.state.friction.jammed);
  EXPECT_LT((motion.state.lambda - lambda).norm(), 1e-12 * lambda.norm());
  EXPECT_LT((motion.state.friction.force - force).norm(), 1e-12 * lambda.norm());
  EXPECT_LT((motion.state.qdd - qdd).norm(), 1e-12 * qdd.norm());
}

/// B^T (N q'' - g - Q - friction): what an implicit stage sets to zero.
VectorXd residual(Motion& motion, const VectorXd& Q, const VectorXd& pd, const VectorXd& pdd) {
  motion.mechanism.set_velocities(motion.state, motion.time, pd.data());
  motion.mechanism.compute_forces(motion.state);
  motion.mechanism.recover(motion.state, Q, pdd.data());
  const MechanismState& s = motion.state;
  const VectorXd r = motion.mechanism.mass_diagonal().cwiseProduct(s.qdd) - s.g - Q - s.friction.A * s.friction.force;
  return s.B.transpose() * r;
}

TEST(SlidingFriction, TheProjectionKnowsHowNormalForcesFollow) {
  Motion motion = moving_crank();
  const int f = motion.mechanism.freedom(), n = motion.mechanism.coordinates();
  ASSERT_EQ(f, 3);
  const VectorXd pdd = VectorXd::LinSpaced(f, 2.0, -3.0);
  residual(motion, motion.Q, motion.pd, pdd);
  MatrixXd projector;
  motion.mechanism.friction_projector(motion.state, projector);
  EXPECT_GT((projector - motion.state.B).norm(), 0.05);
  const MatrixXd by_pdd = projector.transpose() * motion.mechanism.mass_diagonal().asDiagonal() * motion.state.B;
  const double h = 1e-4;  // piecewise linear: no error but rounding
  for (int k = 0; k < f; ++k) {
    const VectorXd step = h * VectorXd::Unit(f, k);
    const VectorXd difference =
        (residual(motion, motion.Q, motion.pd, pdd + step) - residual(motion, motion.Q, motion.pd, pdd - step)) /
        (2.0 * h);
    EXPECT_LT((by_pdd.col(k) - difference).norm(), 1e-8 * by_pdd.norm());
  }
  for (int i = 0; i < n; ++i) {
    const VectorXd step = h * VectorXd::Unit(n, i);
    const VectorXd difference =
        (residual(motion, motion.Q + step, motion.pd, pdd) - residual(motion, motion.Q - step, motion.pd, pdd)) /
        (2.0 * h);
    EXPECT_LT((projector.row(i).transpose() + difference).norm(), 1e-8);
  }
}

/// Two blocks on straight guides joined by a sloping slide: nothing turns, so that B is constant and gamma nought, and
/// the Newton matrix of an implicit stage has all of the residual's derivatives.
MechanismModel wedge() {
  MechanismModel model;
  model.name = "wedge";
  model.bodies = {make_body("wedge", 2.0, 0.1, 0.0, 0.0), make_body("rider", 1.0, 0.1, 0.2, 0.5)};
  model.bodies[0].velocity.x() = 0.4;
  model.joints = {make_joint("floor", JointType::prismatic, ground, 0, 0.0, 0.0, 1.0, 0.0),
                  make_joint("slope", JointType::prismatic, 0, 1, 0.2, 0.4, 1.0, 0.6)};
  model.joints[0].friction = {0.3, 2.0, 0.5};
  model.joints[1].friction = {0.2, 0.0, 0.3};
  model.springs = {make_spring("s", ground, 1, {-1.0, 1.0}, {0.2, 0.5}, 80.0, 3.0)};
  return model;
}

TEST(SlidingFriction, NewtonMatrixMatchesDifferences) {
  Motion motion(wedge());
  const int f = motion.mechanism.freedom(), n = motion.mechanism.coordinates();
  ASSERT_EQ(f, 2);
  motion.pd.setLinSpaced(0.3, -0.2);
  const VectorXd pdd = VectorXd::LinSpaced(f, 2.0, -3.0), Q = VectorXd::LinSpaced(n, -4.0, 9.0), p = motion.p;
  residual(motion, Q, motion.pd, pdd);
  MatrixXd projector, by_q, by_qd;
  motion.mechanism.friction_projector(motion.state, projector);
  motion.mechanism.multiply_tangent(motion.state, -1.0, 0.0, 1.0, by_q);
  motion.mechanism.multiply_tangent(motion.state, 0.0, -1.0, 0.0, by_qd);
  const MatrixXd by_p = projector.transpose() * by_q, by_pd = projector.transpose() * by_qd;
  const double h = 1e-5;
  for (int k = 0; k < f; ++k) {
    const VectorXd step = h * VectorXd::Unit(f, k);
    EXPECT_TRUE(motion.mechanism.set_positions(motion.state, 0.0, p.data()));
    const VectorXd of_pd =
        (residual(motion, Q, motion.pd + step, pdd) - residual(motion, Q, motion.pd - step, pdd)) / (2.0 * h);
    EXPECT_LT((by_pd.col(k) - of_pd).norm(), 1e-7 * by_pd.norm());
    const auto moved = [&](double by) {
      const VectorXd there = p + by * step;
      EXPECT_TRUE(motion.mechanism.set_positions(motion.state, 0.0, there.data()));
      return residual(motion, Q, motion.pd, pdd);
    };
    const VectorXd of_p = (moved(1.0) - moved(-1.0)) / (2.0 * h);
    EXPECT_LT((by_p.col(k) - of_p).norm(), 1e-7 * by_p.norm());
  }
}

/// Generalized force of friction at a fixed level on two bodies given by coordinates and velocities.
Vector6 pair_force(const JointGeometry& joint, double level, const Vector6& q, const Vector6& qd) {
  Frame frames[2];
  for (int i = 0; i < 2; ++i) {
    frames[i].origin = q.segment<2>(3 * i);
    frames[i].set_angle(q[3 * i + 2]);
  }
  const Vector6 gradient = slide_gradient(joint, frames[0], frames[1]);
  return -level * std::tanh(gradient.dot(qd) / joint.friction.transition_speed) * gradient;
}

TEST(SlidingFriction, TangentMatchesDifferencesInEveryPosition) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    MechanismModel model;
    model.name = "pair";
    model.bodies = {make_body("a", 1.0, 1.0, number(random), number(random), number(random)),
                    make_body("b", 2.0, 0.5, number(random), number(random), number(random))};
    for (Body& body : model.bodies) body.velocity << number(random), number(random), number(random);
    model.joints = {make_joint("slot", JointType::slot, 0, 1, number(random), number(random), number(random), 1.0)};
    model.joints[0].friction = {0.5, 2.0, 1.0};
    MechanismModel smooth = model;
    smooth.joints[0].friction = {};
    Motion motion(model), without(smooth);
    motion.finish();
    without.finish();
    const MechanismState& s = motion.state;
    const double level = 0.5 * std::abs(s.lambda[0]) + 2.0, by_q = 0.7, by_qd = -1.3, h = 1e-3;
    MatrixXd product, rest;
    motion.mechanism.multiply_tangent(s, by_q, by_qd, 0.0, product);
    without.mechanism.multiply_tangent(without.state, by_q, by_qd, 0.0, rest);
    Frame a, b;
    a.origin = model.bodies[0].position.head<2>();
    a.set_angle(model.bodies[0].position.z());
    b.origin = model.bodies[1].position.head<2>();
    b.set_angle(model.bodies[1].position.z());
    const JointGeometry joint = joint_geometry(model.joints[0], a, b, 0);
    const Vector6 q = s.q, qd = s.qd;
    EXPECT_LT((pair_force(joint, level, q, qd) - s.friction.A * s.friction.force).norm(), 1e-12 * level);
    Eigen::Matrix<double, 6, 6> K;
    for (int j = 0; j < 6; ++j) {
      const auto at = [&](double by) {
        const Vector6 step = by * h * Vector6::Unit(j);
        return Vector6(by_q * pair_force(joint, level, q + step, qd) + by_qd * pair_force(joint, level, q, qd + step));
      };
      K.col(j) = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
    }
    EXPECT_LT((product - rest - K * s.B).norm(), 1e-8 * level);
  }
}

/// A light shoe on the floor under a heavy block on a wall, a steep rod between: the rod's force grows by the friction
/// of the shoe, by nearly mu tan(slope).
MechanismModel strut(double mu) {
  MechanismModel model;
  model.name = "strut";
  model.bodies = {make_body("shoe", 0.01, 0.1, 0.0, 0.0), make_body("block", 50.0, 0.1, 0.2, 1.0)};
  model.joints = {make_joint("floor", JointType::prismatic, ground, 0, 0.0, 0.0, 1.0, 0.0),
                  make_joint("wall", JointType::prismatic, ground, 1, 0.2, 1.0, 0.0, 1.0),
                  make_distance("rod", 0, 1, {0.0, 0.0}, {0.2, 1.0})};
  model.bodies[0].velocity.x() = -1.0;
  model.joints[0].friction = {mu, 0.0, 1e-3};
  return model;
}

TEST(SlidingFriction, ThatJamsIsSaidInWords) {
  Motion moves(strut(0.19));
  moves.finish();  // mu tan = 0.95
  EXPECT_TRUE(moves.state.qdd.allFinite());
  EXPECT_LT(moves.state.qdd[4], 0.0) << "the block still falls";
  try {
    Motion(strut(0.25)).finish();
    FAIL() << "it does not jam";
  } catch (const SolverError& error) {
    EXPECT_TRUE(test::contains(error.what(), "friction jams joint 'floor'")) << error.what();
  }
}

TEST(SlidingFriction, NeedsANormalForceThatIsDetermined) {
  MechanismModel model = block(1.0, {0.3, 0.0, 0.01}, 0.0);
  model.joints.push_back(make_joint("second", JointType::slot, ground, 0, 0.5, 0.0, 1.0, 0.0));
  model.joints[1].friction = {0.3, 0.0, 0.01};
  const std::string words = test::message_of([&] { Motion{model}; });
  EXPECT_TRUE(test::contains(words, "not determined")) << words;
  for (Joint& joint : model.joints) joint.friction = {0.0, 5.0, 0.01};
  EXPECT_NO_THROW(Motion{model});
}

}  // namespace
}  // namespace traverse::multibody::testing
