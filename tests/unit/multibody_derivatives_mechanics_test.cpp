// Derivatives of every joint and force element against central differences in random positions.
#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "multibody/force_element.hpp"
#include "multibody/joint.hpp"
#include "traverse/base/error.hpp"
#include "unit/mechanism_helpers.hpp"

namespace traverse::multibody::testing {
namespace {

using Eigen::Vector2d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Function = std::function<Eigen::VectorXd(const Vector6&)>;

/// Two bodies as a vector of coordinates and one of velocities.
struct Pair {
  Vector6 q, qd;
  static Frame frame(const Vector6& q, const Vector6& qd, int start) {
    Frame f;
    f.origin = q.segment<2>(start);
    f.set_angle(q[start + 2]);
    f.velocity = qd.segment<2>(start);
    f.omega = qd[start + 2];
    return f;
  }
  Frame first() const { return frame(q, qd, 0); }
  Frame second() const { return frame(q, qd, 3); }
};

Pair random_pair(std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.5, 1.5);
  Pair pair;
  for (int i = 0; i < 6; ++i) {
    pair.q[i] = number(random);
    pair.qd[i] = number(random);
  }
  return pair;
}

/// Fourth-order central differences.
Eigen::MatrixXd differences(const Function& f, const Vector6& at) {
  const double h = 1e-3;
  Eigen::MatrixXd D(f(at).size(), 6);
  for (int j = 0; j < 6; ++j) {
    const auto moved = [&](double by) {
      Vector6 x = at;
      x[j] += by;
      return f(x);
    };
    D.col(j) = (8.0 * (moved(h) - moved(-h)) - (moved(2.0 * h) - moved(-2.0 * h))) / (12.0 * h);
  }
  return D;
}

class EveryJoint : public ::testing::TestWithParam<JointType> {
 protected:
  /// The joint made in one position of the bodies.
  static JointGeometry make(JointType type, std::mt19937& random) {
    const Pair start = random_pair(random);
    Joint joint;
    joint.type = type;
    joint.bodies = {0, 1};
    joint.point = joint.from = random_pair(random).q.head<2>();
    joint.to = random_pair(random).q.tail<2>();
    joint.axis = random_pair(random).q.head<2>();
    joint.numbers = {1.7, -0.6};
    const JointGeometry geometry = joint_geometry(joint, start.first(), start.second(), 0);
    Eigen::VectorXd Phi(type->rows);
    joint_residual(geometry, start.first(), start.second(), Phi.data());
    EXPECT_LT(Phi.cwiseAbs().maxCoeff(), 1e-15 * 10.0);
    return geometry;
  }
  static Eigen::MatrixXd jacobian(const JointGeometry& joint, const Pair& pair) {
    JointJacobian J;
    joint_jacobian(joint, pair.first(), pair.second(), J);
    return J.topRows(joint.type->rows);
  }
};

TEST_P(EveryJoint, DerivativesMatchDifferences) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const JointGeometry joint = make(GetParam(), random);
    const Pair pair = random_pair(random);
    const int rows = joint.type->rows;
    const auto residual = [&](const Vector6& q) {
      const Pair moved{q, pair.qd};
      Eigen::VectorXd Phi(rows);
      joint_residual(joint, moved.first(), moved.second(), Phi.data());
      return Phi;
    };
    const Eigen::MatrixXd J = jacobian(joint, pair);
    const double scale = 1.0 + J.norm();
    EXPECT_LT((J - differences(residual, pair.q)).norm(), 1e-9 * scale);

    // gamma = -(Phi_q q')_q q'
    const auto rate = [&](const Vector6& q) { return Eigen::VectorXd(jacobian(joint, {q, pair.qd}) * pair.qd); };
    Eigen::VectorXd gamma(rows);
    joint_gamma(joint, pair.first(), pair.second(), gamma.data());
    EXPECT_LT((gamma + differences(rate, pair.q) * pair.qd).norm(), 1e-9 * scale * pair.qd.squaredNorm());

    const Eigen::VectorXd lambda = random_pair(random).q.head(rows);
    const auto force = [&](const Vector6& q) {
      return Eigen::VectorXd(jacobian(joint, {q, pair.qd}).transpose() * lambda);
    };
    JointCurvature curvature;
    joint_curvature(joint, pair.first(), pair.second(), lambda.data(), curvature);
    EXPECT_LT((curvature - differences(force, pair.q)).norm(), 1e-9 * scale * (1.0 + lambda.norm()));
    EXPECT_LT((curvature - curvature.transpose()).norm(), 1e-15 * scale);
  }
}

TEST_P(EveryJoint, ReactionIsTheGeneralizedForceOnTheSecondBody) {
  std::mt19937 random(2);
  const JointGeometry joint = make(GetParam(), random);
  const Pair pair = random_pair(random);
  const Eigen::VectorXd lambda = random_pair(random).q.head(joint.type->rows);
  const Vector6 Q = -jacobian(joint, pair).transpose() * lambda;
  const Eigen::Vector3d reaction = joint_reaction(joint, pair.first(), pair.second(), lambda.data());
  const Vector2d arm = pair.second().to_global(joint.second_arm);
  EXPECT_NEAR(reaction.x(), Q[3], 1e-14);
  EXPECT_NEAR(reaction.y(), Q[4], 1e-14);
  EXPECT_NEAR(reaction.z() + arm.x() * reaction.y() - arm.y() * reaction.x(), Q[5], 1e-14);
  // forces balance
  EXPECT_NEAR(Q[0] + Q[3], 0.0, 1e-14);
  EXPECT_NEAR(Q[1] + Q[4], 0.0, 1e-14);
}

std::string joint_type_name(const ::testing::TestParamInfo<JointType>& info) {
  std::string name(info.param->name);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

std::vector<JointType> all_joint_types() {
  std::vector<JointType> types;
  for (const JointRow& row : joint_rows()) types.emplace_back(row);
  return types;
}

INSTANTIATE_TEST_SUITE_P(Joints, EveryJoint, ::testing::ValuesIn(all_joint_types()), joint_type_name);

TEST(JointTypes, AreKnownByTheirNames) {
  for (const JointRow& row : joint_rows()) {
    EXPECT_EQ(JointType::named(row.name), JointType(row));
    EXPECT_FALSE(row.text.empty());
  }
  EXPECT_EQ(JointType::named("slot"), JointType::slot);
  EXPECT_THROW(JointType::named("hinge"), InputError);
  EXPECT_EQ(joint_names([](const JointRow& row) { return row.slides; }, ", ", " or "), "prismatic or slot");
}

SpringGeometry random_spring(std::mt19937& random) {
  const Pair start = random_pair(random);
  Spring spring = make_spring("s", 0, 1, random_pair(random).q.head<2>(), random_pair(random).q.tail<2>(), 3.0, 0.7);
  if (random() % 2 == 0) {
    spring.preload = 1.3;
  } else {
    spring.free_length = 0.4;
  }
  return spring_geometry(spring, start.first(), start.second());
}

TEST(SpringDamper, DerivativesMatchDifferences) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const SpringGeometry spring = random_spring(random);
    const Pair pair = random_pair(random);
    const auto force = [&](const Vector6& q, const Vector6& qd) {
      const Pair moved{q, qd};
      return Eigen::VectorXd(spring_force(spring, moved.first(), moved.second()));
    };
    PairMatrix g_q, g_qd;
    spring_derivatives(spring, pair.first(), pair.second(), g_q, g_qd);
    const auto of_q = [&](const Vector6& q) { return force(q, pair.qd); };
    const auto of_qd = [&](const Vector6& qd) { return force(pair.q, qd); };
    EXPECT_LT((g_q - differences(of_q, pair.q)).norm(), 1e-7 * (1.0 + g_q.norm()));
    EXPECT_LT((g_qd - differences(of_qd, pair.qd)).norm(), 1e-10 * (1.0 + g_qd.norm()));
  }
}

TEST(SpringDamper, ForceIsMinusTheSlopeOfTheEnergyAndTheDamperDissipates) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 20; ++trial) {
    SpringGeometry spring = random_spring(random);
    if (trial % 3 == 0) spring.stiffness = 0.0;  // a constant force
    Pair pair = random_pair(random);
    const auto energy = [&](const Vector6& q) {
      const Pair moved{q, pair.qd};
      return Eigen::VectorXd::Constant(1, spring_strain_energy(spring, moved.first(), moved.second()));
    };
    const double dissipation = spring_dissipation(spring, pair.first(), pair.second());
    const double stored = (differences(energy, pair.q) * pair.qd)[0];
    const double power = spring_force(spring, pair.first(), pair.second()).dot(pair.qd);
    EXPECT_GE(dissipation, 0.0);
    EXPECT_NEAR(stored + power + dissipation, 0.0, 1e-8);
  }
}

TEST(SpringDamper, PreloadIsTheForceAtTheStart) {
  Spring spring = make_spring("s", ground, 0, {0.0, 2.0}, {0.0, 0.5}, 100.0);
  Frame body;
  body.origin = {0.0, 0.0};
  spring.preload = 7.0;
  EXPECT_DOUBLE_EQ(spring_force(spring_geometry(spring, Frame(), body), Frame(), body)[4], 7.0);  // pulled upward
  spring.preload.reset();
  EXPECT_EQ(spring_force(spring_geometry(spring, Frame(), body), Frame(), body)[4], 0.0);
  spring.free_length = 1.0;
  EXPECT_DOUBLE_EQ(spring_force(spring_geometry(spring, Frame(), body), Frame(), body)[4], 50.0);
}

TEST(SpringDamper, ZeroLengthSpringHasAStiffnessInAllDirections) {
  const SpringGeometry spring =
      spring_geometry(make_spring("s", ground, 0, {0.0, 0.0}, {0.0, 0.0}, 5.0, 2.0), Frame(), Frame());
  PairMatrix g_q, g_qd;
  spring_derivatives(spring, Frame(), Frame(), g_q, g_qd);
  EXPECT_EQ(spring_force(spring, Frame(), Frame()), PairForce::Zero());
  EXPECT_DOUBLE_EQ(g_q(3, 3), -5.0);
  EXPECT_DOUBLE_EQ(g_q(4, 4), -5.0);
  EXPECT_TRUE(g_q.allFinite() && g_qd.allFinite());
}

TEST(TorsionSpringDamper, MomentOpposesTheTwist) {
  TorsionSpring spring{"t", {0, 1}, 4.0, 0.5, std::nullopt};
  Frame first, second;
  first.set_angle(0.2);
  second.set_angle(0.5);
  const TorsionGeometry geometry = torsion_geometry(spring, first, second);
  EXPECT_EQ(torsion_moment(geometry, first, second), 0.0);
  second.set_angle(0.6);
  second.omega = 2.0;
  EXPECT_DOUBLE_EQ(torsion_moment(geometry, first, second), -4.0 * 0.1 - 0.5 * 2.0);
  EXPECT_DOUBLE_EQ(torsion_strain_energy(geometry, first, second), 0.5 * 4.0 * 0.01);
  EXPECT_DOUBLE_EQ(torsion_dissipation(geometry, first, second), 2.0);
}

/// A mechanism with one of everything.
MechanismModel one_of_everything() {
  MechanismModel model;
  model.name = "everything";
  model.bodies = {make_body("a", 2.0, 0.5, 0.1, 0.2, 0.3), make_body("b", 1.0, 0.2, 1.0, 0.1, -0.2),
                  make_body("c", 3.0, 0.7, 2.0, -0.4, 0.1), make_body("d", 1.5, 0.4, 3.0, 0.5, 0.6)};
  model.joints = {make_joint("pin", JointType::revolute, ground, 0, 0.0, 0.0),
                  make_joint("slot", JointType::slot, 0, 1, 0.5, 0.3, 0.2, 1.0),
                  make_distance("rod", 1, 2, {1.2, 0.2}, {1.8, -0.3})};
  model.drivers = {{"drive", 2, 0, base::TimeFunction({0.0, 1.0, 2.0}, {2.0, 2.3, 2.1})}};
  model.springs = {make_spring("s1", 0, 2, {0.1, 0.3}, {2.0, 0.4}, 50.0, 3.0),
                   make_spring("s2", ground, 3, {2.5, 1.0}, {3.1, 0.4}, 70.0, 2.0)};
  model.torsion_springs = {{"t1", {1, 3}, 9.0, 0.4, 0.1}, {"t2", {ground, 2}, 5.0, 0.3, std::nullopt}};
  Actuator actuator;
  actuator.body = 1;
  actuator.reaction_body = 3;
  actuator.action = {base::TimeFunction(1.0, 2.0), base::TimeFunction(-3.0, 0.0), base::TimeFunction(0.5, 1.0)};
  model.actuators = {actuator};
  return model;
}

TEST(Mechanism, ForceDerivativesMatchDifferencesOfTheWhole) {
  // no constraints: all coordinates are free
  MechanismModel model = one_of_everything();
  model.joints.clear();
  model.drivers.clear();
  Motion motion(model);
  ASSERT_EQ(motion.mechanism.freedom(), 12);
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(12, -1.0, 2.0), qd = Eigen::VectorXd::LinSpaced(12, 3.0, -1.0);
  const auto force = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& rate) {
    motion.mechanism.set_positions(motion.state, 0.3, at.data());
    motion.mechanism.set_velocities(motion.state, 0.3, rate.data());
    motion.mechanism.compute_forces(motion.state);
    return motion.state.g;
  };
  for (int j = 0; j < 12; ++j) {
    const Eigen::VectorXd step = 1e-5 * Eigen::VectorXd::Unit(12, j);
    const Eigen::VectorXd by_q = (force(q + step, qd) - force(q - step, qd)) / 2e-5;
    const Eigen::VectorXd by_qd = (force(q, qd + step) - force(q, qd - step)) / 2e-5;
    force(q, qd);
    Eigen::MatrixXd product;  // B is the identity
    motion.mechanism.multiply_tangent(motion.state, 1.0, 0.0, 0.0, product);
    EXPECT_LT((product.col(j) - by_q).norm(), 1e-6);
    motion.mechanism.multiply_tangent(motion.state, 0.0, 1.0, 0.0, product);
    EXPECT_LT((product.col(j) - by_qd).norm(), 1e-6);
  }
}

TEST(Mechanism, VelocitiesAndAccelerationsAreTheTimeDerivativesOfThePositions) {
  Motion motion(one_of_everything());
  const int f = motion.mechanism.freedom();
  ASSERT_EQ(f, 7);  // 12 coordinates less 2 + 1 + 1 + 1
  const Eigen::VectorXd p0 = motion.p;
  const Eigen::VectorXd p1 = Eigen::VectorXd::LinSpaced(f, -0.3, 0.4), p2 = Eigen::VectorXd::LinSpaced(f, 0.5, -0.2);
  const auto position = [&](double t) {
    const Eigen::VectorXd p = p0 + t * p1 + 0.5 * t * t * p2;
    EXPECT_TRUE(motion.mechanism.set_positions(motion.state, t, p.data()));
    return motion.state.q;
  };
  const double t = 0.4, h = 1e-3;
  const Eigen::VectorXd before2 = position(t - 2 * h), before = position(t - h), after = position(t + h),
                        after2 = position(t + 2 * h), now = position(t);
  const Eigen::VectorXd qd = (8.0 * (after - before) - (after2 - before2)) / (12.0 * h);
  const Eigen::VectorXd qdd = (16.0 * (after + before) - (after2 + before2) - 30.0 * now) / (12.0 * h * h);
  const Eigen::VectorXd pd = p1 + t * p2;
  motion.mechanism.set_velocities(motion.state, t, pd.data());
  motion.mechanism.compute_forces(motion.state);
  motion.mechanism.recover(motion.state, motion.Q, p2.data());
  EXPECT_LT((motion.state.qd - qd).norm(), 1e-9);
  EXPECT_LT((motion.state.qdd - qdd).norm(), 1e-7);
  EXPECT_LT((motion.state.qd - motion.state.B * pd - motion.state.b).norm(), 1e-14);
  EXPECT_LT((motion.state.qdd - motion.state.B * p2 - motion.state.d).norm(), 1e-14);
}

TEST(Mechanism, AccelerationsSolveTheFullSystem) {
  // eq. 42 itself: [N Phi_q^T; Phi_q 0] [q''; lambda] = [g + Q; gamma]
  Motion motion(one_of_everything());
  const Eigen::VectorXd Q = Eigen::VectorXd::LinSpaced(12, -4.0, 9.0);
  motion.Q = Q;
  motion.p.array() += 0.05;
  motion.pd.setLinSpaced(-1.0, 1.0);
  Eigen::VectorXd pdd(motion.mechanism.freedom());
  ASSERT_TRUE(motion.evaluate(0.2, pdd.data()));
  const MechanismState& s = motion.state;
  const int n = 12, m = motion.mechanism.constraints();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m);
  K.topLeftCorner(n, n) = motion.mechanism.mass_diagonal().asDiagonal();
  K.topRightCorner(n, m) = s.Phi_q.transpose();
  K.bottomLeftCorner(m, n) = s.Phi_q;
  Eigen::VectorXd rhs(n + m);
  rhs << s.g + Q, s.gamma;
  const Eigen::VectorXd x = K.fullPivLu().solve(rhs);
  EXPECT_LT((x.head(n) - s.qdd).norm(), 1e-11 * x.head(n).norm());
  EXPECT_LT((x.tail(m) - s.lambda).norm(), 1e-11 * x.tail(m).norm());
  // the energy balance in rates: forces times velocities
  const MechanismEnergy e = motion.mechanism.energy(s);
  const double kinetic_rate = s.qd.dot(motion.mechanism.mass_diagonal().cwiseProduct(s.qdd));
  const double h = 1e-5;
  const auto stored = [&](double by) {
    MechanismState moved = s;
    const Eigen::VectorXd p = motion.p + by * motion.pd + 0.5 * by * by * pdd;
    EXPECT_TRUE(motion.mechanism.set_positions(moved, 0.2 + by, p.data()));
    const MechanismEnergy there = motion.mechanism.energy(moved);
    return there.strain + there.potential;
  };
  const double stored_rate = (stored(h) - stored(-h)) / (2.0 * h);
  EXPECT_NEAR(kinetic_rate + stored_rate, e.work - e.dissipation + Q.dot(s.qd), 1e-6);
  EXPECT_GT(e.dissipation, 0.0);
  EXPECT_NE(e.work, 0.0);
}

TEST(Mechanism, LambdaCurvatureMatchesDifferencesOfTheWhole) {
  Motion motion(one_of_everything());
  motion.finish();
  Eigen::MatrixXd product;
  motion.mechanism.multiply_tangent(motion.state, 0.0, 0.0, 1.0, product);
  const MechanismState& s = motion.state;
  // differences along the independent directions, where the mechanism can go
  for (int k = 0; k < motion.mechanism.freedom(); ++k) {
    const auto force = [&](double by) {
      MechanismState moved = s;
      const Eigen::VectorXd p = motion.p + by * Eigen::VectorXd::Unit(motion.p.size(), k);
      EXPECT_TRUE(motion.mechanism.set_positions(moved, s.time, p.data()));
      motion.mechanism.set_velocities(moved, s.time, motion.pd.data());
      return Eigen::VectorXd(moved.Phi_q.transpose() * s.lambda);
    };
    const Eigen::VectorXd difference = (force(1e-5) - force(-1e-5)) / 2e-5;
    EXPECT_LT((product.col(k) - difference).norm(), 1e-6 * (1.0 + s.lambda.norm()));
  }
}

}  // namespace
}  // namespace traverse::multibody::testing
