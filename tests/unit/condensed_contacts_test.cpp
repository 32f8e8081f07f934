// CondensedContacts against Newton's method with dense matrices on the equations at the head of its header.
#include "coupling/condensed_contacts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "support/beam_model.hpp"
#include "support/dense.hpp"

namespace traverse::coupling {
namespace {

constexpr double scale = 1e5;  // N, of every vehicle

/// Contacts of vehicles on a beam, with numbers in place of the mechanisms behind them.
class Contacts : public testing::Test {
 protected:
  Contacts() : beam_(MPI_COMM_SELF, model()), op_(damped(beam_)), compliance_(beam_, op_) {}

  static beam::Beam& damped(beam::Beam& beam) {
    beam.set_rayleigh({0.4, 2e-4});
    return beam;
  }
  static beam::BeamModel model() {
    auto model = test::model_of({20.0, 20.0}, 10);
    model.foundation.vertical_bed = beam::Bed{1e6, 1e4};
    return model;
  }

  /// A vehicle with a contact on each of the elements (of the list that is prepared; -1: rigid ground).
  void add_vehicle(const std::vector<int>& slots, contact::LawKind kind, double friction, bool with_P = false) {
    train::Unit unit;
    unit.mechanism.bodies.resize(1);
    unit.mechanism.bodies[0].name = "body";
    unit.mechanism.bodies[0].mass = 1.0;
    unit.mechanism.bodies[0].inertia = 1.0;
    fleet_.vehicles.emplace_back(std::move(unit));
    train::MovingVehicle& vehicle = fleet_.vehicles.back();
    vehicle.scale = scale;
    vehicle.state.q = Eigen::Vector3d(-static_cast<double>(fleet_.vehicles.size()), 0.0, 0.0);
    for (int slot : slots) {
      train::WheelContact c;
      c.vehicle = static_cast<int>(fleet_.vehicles.size()) - 1;
      c.law.kind = kind;
      c.law.stiffness = kind == contact::LawKind::hertz ? 9e10 : 1e9;
      c.law.damping = 1e4;
      c.law.friction = friction;
      c.slots = {slot, -1};
      // Held where the law gives about what a wheel carries; the geometry has gone on from there.
      const double penetration = contact::static_penetration(c.law, 5e4);
      c.kinematics = {penetration, 0.01 * number(), 0.02 * number()};
      c.touch.kinematics = {penetration * (1.0 + 0.1 * number()), 0.01 * number(), 0.02 * number()};
      c.force = contact::force(c.law, c.kinematics, 0.0);
      // Rotations are felt less than deflections by what an element is long.
      for (int i = 0; i < 6; ++i) {
        c.touch.normal_on_beam[i] = (i % 3 == 2 ? 0.3 : 1.0) * number();
        c.touch.tangent_on_beam[i] = (i % 3 == 2 ? 0.3 : 1.0) * number();
      }
      vehicle.touching.push_back(static_cast<int>(fleet_.wheels.size()));
      fleet_.wheels.push_back(c);
    }
    with_P_.push_back(with_P);
  }

  void prepare(double shift, double shift2, const std::vector<int>& elements) {
    shift_ = shift;
    elements_ = elements;
    compliance_.prepare(shift, shift2, nullptr, elements);
    inverse_ = test::dense_inverse(beam_, test::dense_operator(beam_, shift, shift2));
  }

  /// Numbers for how the vehicles yield, which all rows get.
  void couple(bool on_beam = true) {
    contacts_.list(fleet_);
    on_beam_ = on_beam;
    for (std::size_t k = 0; k < with_P_.size(); ++k) {
      const int n = contacts_.rows(static_cast<int>(k));
      train::ContactCompliance& compliance = contacts_.compliance(static_cast<int>(k));
      compliance.H.resize(n, n);
      for (int i = 0; i < n * n; ++i) compliance.H.data()[i] = number();
      compliance.H = 2e-9 * (compliance.H * compliance.H.transpose() + Eigen::MatrixXd::Identity(n, n)).eval();
      compliance.P.resize(0, 0);
      if (with_P_[k]) {
        compliance.P = Eigen::MatrixXd::Identity(n, n);
        for (int i = 0; i < n * n; ++i) compliance.P.data()[i] += 0.2 * number();
      }
      compliance.c.resize(n);
      for (int i = 0; i < n; ++i) compliance.c[i] = 2e-5 * number();
    }
    contacts_.couple(on_beam ? &compliance_ : nullptr, 3);
  }

  int rows() const { return contacts_.size(); }

  struct Dense {
    Eigen::MatrixXd H, P, W;
    Eigen::VectorXd c;
  };
  Dense dense() {
    const int n = rows();
    Dense d{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, n),
            Eigen::VectorXd::Zero(n)};
    for (int k = 0; k < static_cast<int>(with_P_.size()); ++k) {
      const int from = contacts_.first(k), count = contacts_.rows(k);
      const train::ContactCompliance& compliance = contacts_.compliance(k);
      d.H.block(from, from, count, count) = compliance.H;
      if (compliance.P.size() != 0) d.P.block(from, from, count, count) = compliance.P;
      d.c.segment(from, count) = compliance.c;
    }
    Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(inverse_.rows(), n);
    for (int i = 0; i < n && on_beam_; ++i) {
      const train::ContactRow& row = contacts_.row(i);
      if (row.contact->slot() < 0) continue;
      const auto unknowns = beam_.running().unknowns(elements_[row.contact->slot()]);
      const auto& direction = row.normal ? row.contact->touch.normal_on_beam : row.contact->touch.tangent_on_beam;
      for (int j = 0; j < 6; ++j) directions(unknowns[j], i) = direction[j];
    }
    d.W = directions.transpose() * inverse_ * directions;
    return d;
  }

  contact::Kinematics kinematics(int row, const Eigen::VectorXd& delta) const {
    const int first = contacts_.row(row).normal ? row : row - 1;
    const bool has_friction = first + 1 < rows() && !contacts_.row(first + 1).normal;
    contact::Kinematics k = contacts_.row(first).contact->touch.kinematics;
    k.penetration += delta[first];
    k.penetration_rate += shift_ * delta[first];
    if (has_friction) k.sliding_speed += shift_ * delta[first + 1];
    return k;
  }
  Eigen::VectorXd forces(const Eigen::VectorXd& delta) const {
    Eigen::VectorXd F(rows());
    for (int i = 0; i < rows(); ++i) {
      const train::Contact& c = *contacts_.row(i).contact;
      const contact::Force f = contact::force(c.law, kinematics(i, delta), c.approach_speed);
      F[i] = c.factor * (contacts_.row(i).normal ? f.normal : f.tangential);
    }
    return F;
  }
  Eigen::MatrixXd tangents(const Eigen::VectorXd& delta) const {
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(rows(), rows());
    for (int i = 0; i < rows(); ++i) {
      const train::Contact& c = *contacts_.row(i).contact;
      const contact::Force f = contact::force(c.law, kinematics(i, delta), c.approach_speed);
      if (contacts_.row(i).normal) {
        D(i, i) = c.factor * (f.normal_by_penetration + shift_ * f.normal_by_rate);
      } else {
        D(i, i - 1) = c.factor * (f.tangential_by_penetration + shift_ * f.tangential_by_rate);
        D(i, i) = c.factor * shift_ * f.tangential_by_sliding;
      }
    }
    return D;
  }

  /// P delta + H (F - F_held) + P W (F - F_held) = c, or with all of F in the last term where the geometry has the beam
  /// without load; Newton with a step that is halved while the residual grows.
  Eigen::VectorXd newton(const Dense& d, const Eigen::VectorXd& held, bool loaded) const {
    const auto residual = [&](const Eigen::VectorXd& delta) -> Eigen::VectorXd {
      const Eigen::VectorXd F = forces(delta);
      return d.P * delta + d.H * (F - held) + d.P * (d.W * (loaded ? Eigen::VectorXd(F - held) : F)) - d.c;
    };
    Eigen::VectorXd delta = Eigen::VectorXd::Zero(rows());
    for (int i = 0; i < 200; ++i) {
      const Eigen::VectorXd r = residual(delta);
      const Eigen::MatrixXd J = d.P + (d.H + d.P * d.W) * tangents(delta);
      const Eigen::VectorXd step = J.fullPivLu().solve(r);
      if (step.norm() <= 1e-15 * (1e-4 + delta.norm())) break;
      double share = 1.0;
      while (share > 1e-3 && residual(delta - share * step).norm() > r.norm()) share *= 0.5;
      delta -= share * step;
    }
    return delta;
  }

  /// Solves and compares everything that the class gives with the dense solution.
  void expect_dense(bool loaded, double precision = 1e-9) {
    const Dense d = dense();
    Eigen::VectorXd held(rows());
    for (int i = 0; i < rows(); ++i) {
      const train::ContactRow& row = contacts_.row(i);
      held[i] = row.normal ? row.contact->force.normal : row.contact->force.tangential;
    }
    const Eigen::VectorXd delta = newton(d, held, loaded), F = forces(delta);
    const Eigen::VectorXd beam = -d.W * (loaded ? Eigen::VectorXd(F - held) : F);
    std::vector<contact::Kinematics> at;
    for (int i = 0; i < rows(); ++i) at.push_back(kinematics(i, delta));

    EXPECT_LE(contacts_.solve(shift_, loaded, 50), 1e-11);
    const double size = delta.cwiseAbs().maxCoeff(), weight = held.cwiseAbs().maxCoeff();
    for (int i = 0; i < rows(); ++i) {
      SCOPED_TRACE(i);
      const train::ContactRow& row = contacts_.row(i);
      EXPECT_NEAR(row.contact->kinematics.penetration, at[i].penetration, precision * size);
      EXPECT_NEAR(row.contact->kinematics.penetration_rate, at[i].penetration_rate, precision * shift_ * size);
      EXPECT_NEAR(row.contact->kinematics.sliding_speed, at[i].sliding_speed, precision * shift_ * size);
      EXPECT_NEAR(row.normal ? row.contact->force.normal : row.contact->force.tangential, F[i], precision * weight);
      EXPECT_NEAR(contacts_.change(i), F[i] - held[i], precision * weight);
      EXPECT_NEAR(contacts_.displacement(i), delta[i] - beam[i],
                  precision * std::max(size, beam.cwiseAbs().maxCoeff()));
    }
  }

  double number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }

  beam::Beam beam_;
  structure::BeamOperator op_;
  structure::Compliance compliance_;
  train::Fleet fleet_;
  CondensedContacts contacts_;
  std::vector<char> with_P_;
  std::vector<int> elements_;
  Eigen::MatrixXd inverse_;
  double shift_ = 0.0;
  bool on_beam_ = true;
  std::mt19937 random_{11};
};

TEST_F(Contacts, OfOneVehicleThatRubs) {
  for (bool loaded : {true, false}) {
    fleet_ = {};
    with_P_.clear();
    prepare(400.0, 1.6e5, {3, 4, 9});
    add_vehicle({0, 1, 2}, contact::LawKind::hertz, 0.3);
    couple();
    EXPECT_EQ(rows(), 6);
    expect_dense(loaded);
  }
}

TEST_F(Contacts, OfVehiclesThatShareElements) {
  prepare(400.0, 1.6e5, {3, 4, 9});
  add_vehicle({0, 1}, contact::LawKind::hertz, 0.0);
  add_vehicle({1, -1, 2}, contact::LawKind::linear, 0.2);  // one wheel is still on rigid ground
  add_vehicle({2}, contact::LawKind::hertz, 0.4);
  couple();
  EXPECT_EQ(rows(), 2 + 6 + 2);
  EXPECT_EQ(contacts_.first(2), 8);
  EXPECT_EQ(contacts_.rows(1), 6);
  expect_dense(true);
  couple();  // from where they are now
  expect_dense(false);
}

// H knows a tangent of the law already, as statics has it.
TEST_F(Contacts, AtRest) {
  for (bool loaded : {true, false}) {
    fleet_ = {};
    with_P_.clear();
    prepare(0.0, 0.0, {3, 12});
    add_vehicle({0, 1}, contact::LawKind::hertz, 0.0, true);
    add_vehicle({1}, contact::LawKind::hertz, 0.0);
    couple();
    expect_dense(loaded);
  }
}

TEST_F(Contacts, OnRigidGround) {
  shift_ = 400.0;
  add_vehicle({-1, -1}, contact::LawKind::hertz, 0.3);
  couple(false);
  expect_dense(true);
}

// One lets go, another comes to touch: the laws have a kink on the way.
TEST_F(Contacts, ThatOpenAndClose) {
  prepare(400.0, 1.6e5, {3, 4, 9});
  add_vehicle({0, 1, 2}, contact::LawKind::hertz, 0.2);
  train::Contact &opens = fleet_.wheels[0], &closes = fleet_.wheels[1];
  opens.touch.kinematics.penetration = -2e-4;
  closes.kinematics = {-1e-4, 0.02, 0.01};
  closes.force = contact::force(closes.law, closes.kinematics, 0.0);
  closes.touch.kinematics = {3e-5, 0.02, 0.01};
  ASSERT_EQ(closes.force.normal, 0.0);
  ASSERT_GT(opens.force.normal, 0.0);
  couple();
  expect_dense(true);
  EXPECT_EQ(opens.force.normal, 0.0);
  EXPECT_GT(closes.force.normal, 0.0);
}

// What neighbouring points of a wheel share is taken away once.
TEST_F(Contacts, OfTheSignThatTakesAway) {
  prepare(400.0, 1.6e5, {3});
  add_vehicle({0, 0, 0}, contact::LawKind::hertz, 0.3);
  train::Contact& between = fleet_.wheels[2];
  between.factor = -1.0;
  between.kinematics.penetration *= 0.5;
  between.touch.kinematics.penetration = between.kinematics.penetration;
  between.force = train::force_of(between);
  couple();
  expect_dense(true);
  EXPECT_LT(between.force.normal, 0.0);
}

// Of vehicles far apart the rows hardly know of each other: those that do not matter are left out.
TEST_F(Contacts, OfALongTrainWithinWhatIsNegligible) {
  auto long_model = test::model_of({400.0}, 200);
  long_model.foundation.vertical_bed = beam::Bed{2e7, 1e5};
  beam::Beam beam(MPI_COMM_SELF, long_model);
  structure::BeamOperator op(damped(beam));
  structure::Compliance compliance(beam, op);
  std::vector<int> list;
  for (int e = 5; e < 195; e += 19) list.push_back(e);
  compliance.prepare(400.0, 1.6e5, nullptr, list);
  prepare(400.0, 1.6e5, {0});
  for (int k = 0; k < static_cast<int>(list.size()); ++k) add_vehicle({k}, contact::LawKind::hertz, 0.0);
  couple(false);
  contacts_.couple(&compliance, 3);
  ASSERT_LT(compliance.response(5).last - compliance.response(5).first, 11);
  Dense d = dense();
  const Eigen::MatrixXd inverse = test::dense_inverse(beam, test::dense_operator(beam, 400.0, 1.6e5));
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(inverse.rows(), rows());
  Eigen::VectorXd held(rows());
  for (int i = 0; i < rows(); ++i) {
    for (int j = 0; j < 6; ++j)
      directions(beam.running().unknowns(list[i])[j], i) = contacts_.row(i).contact->touch.normal_on_beam[j];
    held[i] = contacts_.row(i).contact->force.normal;
  }
  d.W = directions.transpose() * inverse * directions;
  const Eigen::VectorXd delta = newton(d, held, true), F = forces(delta);
  EXPECT_LE(contacts_.solve(400.0, true, 50), 1e-11);
  for (int i = 0; i < rows(); ++i) EXPECT_NEAR(contacts_.row(i).contact->force.normal, F[i], 1e-8 * 5e4) << i;
}

TEST_F(Contacts, KnowWhenOneHasGoneOver) {
  prepare(400.0, 1.6e5, {3, 4});
  add_vehicle({0, 1}, contact::LawKind::hertz, 0.1);
  couple();
  EXPECT_FALSE(contacts_.moved());
  fleet_.wheels[0].slots[1] = 1;
  EXPECT_FALSE(contacts_.moved());
  fleet_.wheels[0].active = 1;
  EXPECT_TRUE(contacts_.moved());
  EXPECT_FALSE(contacts_.moved());
}

}  // namespace
}  // namespace traverse::coupling
