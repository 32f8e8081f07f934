// Springs and dampers that are not linear: tables, play, one side only.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "multibody/force_element.hpp"
#include "support/message.hpp"
#include "traverse/base/error.hpp"
#include "traverse/base/force_law.hpp"
#include "unit/mechanism_helpers.hpp"

namespace traverse::multibody::testing {

using base::ForceLaw;
using base::Polyline;
using base::Side;

namespace {

using test::contains;
using test::message_of;

/// A progressive spring, a damper that blows off.
ForceLaw rich_law(double gap, Side side) {
  return {Polyline({-0.5, -0.1, 0.0, 0.2, 0.6}, {-90.0, -12.0, 0.0, 15.0, 80.0}),
          Polyline({-0.4, 0.0, 0.3, 0.9}, {-30.0, 0.0, 20.0, 26.0}), gap, side};
}

constexpr Side sides[] = {Side::both, Side::compression, Side::tension};

TEST(Polyline, ValueSlopeAndIntegral) {
  const Polyline p({-1.0, 0.5, 2.0}, {-2.0, 1.0, 1.0});
  EXPECT_DOUBLE_EQ(p.value(-3.0), -6.0);
  EXPECT_DOUBLE_EQ(p.value(0.0), 0.0);
  EXPECT_DOUBLE_EQ(p.value(1.0), 1.0);
  EXPECT_DOUBLE_EQ(p.value(5.0), 1.0);
  EXPECT_DOUBLE_EQ(p.slope(-3.0), 2.0);
  EXPECT_DOUBLE_EQ(p.slope(0.5), 0.0);
  EXPECT_DOUBLE_EQ(p.integral(0.0), 0.0);
  EXPECT_DOUBLE_EQ(p.integral(-3.0), 9.0);
  EXPECT_DOUBLE_EQ(p.integral(3.0), 0.25 + 2.5);
}

TEST(Polyline, Inverse) {
  const Polyline rising({-1.0, 0.5, 2.0}, {-2.0, 1.0, 1.5});
  for (const double x : {-4.0, -1.0, 0.3, 0.5, 1.0, 7.0})
    EXPECT_NEAR(rising.inverse(rising.value(x)).value(), x, 1e-14);
  EXPECT_FALSE(Polyline({0.0, 1.0, 2.0}, {0.0, 1.0, 1.0}).inverse(0.5));
}

TEST(Polyline, RefusesWhatIsNoTable) {
  EXPECT_PRED2(contains, message_of([] { Polyline({0.0}, {0.0}); }), "at least two rows");
  EXPECT_PRED2(contains, message_of([] { Polyline({0.0, 1.0, 1.0}, {0.0, 1.0, 2.0}); }), "row 3 has 1 after 1");
  EXPECT_THROW(Polyline({0.0, 1.0}, {0.0, std::nan("")}), InputError);
  EXPECT_THROW(Polyline({0.0, 1.0}, {0.0}), InputError);
}

TEST(Polyline, SaysWhereValueAndArgumentDifferInSign) {
  EXPECT_EQ(rich_law(0.0, Side::both).damper.opposing(), "");
  EXPECT_PRED2(contains, Polyline({-1.0, 1.0, 2.0}, {-1.0, 1.0, -3.0}).opposing(), "-3 at 2");
  EXPECT_PRED2(contains, Polyline({1.0, 2.0}, {2.0, 3.0}).opposing(), "1 at 0");
  EXPECT_PRED2(contains, Polyline({-1.0, 0.0, 1.0, 2.0}, {-1.0, 0.0, 1.0, 0.5}).opposing(), "last line");
  EXPECT_PRED2(contains, Polyline({-2.0, -1.0, 0.0, 1.0}, {-1.0, -2.0, 0.0, 1.0}).opposing(), "first line");
}

TEST(ForceLaw, SlopesMatchDifferences) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const double h = 1e-6;
  for (const double gap : {0.0, 0.05})
    for (const Side side : sides) {
      const ForceLaw law = rich_law(gap, side);
      int compared = 0;
      for (int trial = 0; trial < 400; ++trial) {
        const double e = number(random), rate = number(random);
        const base::Tension t = base::tension(law, e, rate);
        const base::Tension ahead = base::tension(law, e + 2.0 * h, rate),
                            behind = base::tension(law, e - 2.0 * h, rate);
        const base::Tension faster = base::tension(law, e, rate + 2.0 * h),
                            slower = base::tension(law, e, rate - 2.0 * h);
        // a corner in between shows as another slope on either side
        if (ahead.by_elongation != behind.by_elongation || faster.by_rate != slower.by_rate ||
            (ahead.tension == 0.0) != (behind.tension == 0.0))
          continue;
        ++compared;
        EXPECT_NEAR(t.by_elongation, (ahead.tension - behind.tension) / (4.0 * h), 1e-6);
        EXPECT_NEAR(t.by_rate, (faster.tension - slower.tension) / (4.0 * h), 1e-6);
        const double slope = (base::stored_energy(law, e + h) - base::stored_energy(law, e - h)) / (2.0 * h);
        EXPECT_NEAR((t.tension - slope) * rate, t.dissipation, 1e-4);
        EXPECT_GE(t.dissipation, 0.0);
      }
      EXPECT_GT(compared, 350);
    }
}

TEST(ForceLaw, NeverPullsOrPushesWhereItIsLoose) {
  for (const double gap : {0.0, 0.05})
    for (const Side side : sides) {
      const ForceLaw law = rich_law(gap, side);
      if (!law.can_disengage()) continue;
      for (double e = -1.0; e <= 1.0; e += 0.01)
        for (const double rate : {-5.0, -0.5, 0.0, 0.5, 5.0}) {
          const double t = base::tension(law, e, rate).tension;
          const bool taut = std::abs(e) > gap && (side == Side::both || (e > 0.0) == (side == Side::tension));
          if (taut) {
            EXPECT_GE(t * e, 0.0);
          } else {
            EXPECT_EQ(t, 0.0);
            EXPECT_EQ(base::stored_energy(law, e), 0.0);
          }
        }
    }
  EXPECT_GT(base::tension(rich_law(0.05, Side::both), 0.3, -0.1).tension, 0.0);
  EXPECT_EQ(base::tension(rich_law(0.05, Side::both), 0.06, -5.0).tension, 0.0);
}

// A rope of k and c: slack at e <= 0; taut but without tension where its ends approach faster than the damper allows.
// Tension times rate is what is stored and what is dissipated.
TEST(ForceLaw, SlackRope) {
  constexpr double k = 4.0e5, c = 3.0e4;
  const ForceLaw rope{Polyline::line(k), Polyline::line(c), 0.0, Side::tension};
  for (const double e : {-0.02, -1e-6, 1e-3, 0.02})
    for (const double rate : {-2.0, -0.01, 0.0, 0.01, 2.0}) {
      SCOPED_TRACE(std::to_string(e) + " m, " + std::to_string(rate) + " m/s");
      const base::Tension t = base::tension(rope, e, rate);
      const double expected = e > 0.0 ? std::max(0.0, k * e + c * rate) : 0.0;
      EXPECT_NEAR(t.tension, expected, 1e-9 * k);
      EXPECT_NEAR(base::stored_energy(rope, e), e > 0.0 ? 0.5 * k * e * e : 0.0, 1e-9);
      EXPECT_NEAR(t.dissipation, expected > 0.0 ? c * rate * rate : e > 0.0 ? -k * e * rate : 0.0, 1e-6);
      EXPECT_GE(t.dissipation, 0.0);
      EXPECT_NEAR(t.tension * rate, (e > 0.0 ? k * e * rate : 0.0) + t.dissipation, 1e-6);
    }
}

TEST(ForceLaw, TheDamperComesOnSteadily) {
  const ForceLaw law = rich_law(0.05, Side::compression);
  const double e = -0.05 - 0.4e-9, h = 1e-11, rate = -0.2;
  const double slope = (base::tension(law, e + h, rate).tension - base::tension(law, e - h, rate).tension) / (2.0 * h);
  EXPECT_NEAR(base::tension(law, e, rate).by_elongation / slope, 1.0, 1e-6);
  EXPECT_NEAR(base::tension(law, e, rate).tension, -0.4 * 15.0, 1e-6);  // the damper's 15 N, not much of the spring's
}

TEST(ForceLaw, ElongationAtATension) {
  for (const double gap : {0.0, 0.05})
    for (const double wanted : {-40.0, -3.0, 3.0, 40.0}) {
      const ForceLaw law = rich_law(gap, Side::both);
      EXPECT_NEAR(base::tension(law, law.elongation_at(wanted).value(), 0.0).tension, wanted, 1e-12);
    }
  EXPECT_EQ(rich_law(0.05, Side::both).elongation_at(0.0), 0.0);
  EXPECT_FALSE(rich_law(0.05, Side::tension).elongation_at(-1.0));
  EXPECT_TRUE(rich_law(0.05, Side::tension).elongation_at(1.0));
}

Frame random_frame(std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.5, 1.5);
  Frame f;
  f.origin = {number(random), number(random)};
  f.velocity = {number(random), number(random)};
  f.set_angle(number(random));
  f.omega = number(random);
  return f;
}

TEST(SpringWithALaw, StraightTablesAreALinearSpring) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Frame first = random_frame(random), second = random_frame(random);
    Spring linear = make_spring("s", 0, 1, {0.2, 0.1}, {1.0, -0.7}, 30.0, 4.0);
    Spring table = linear;
    table.stiffness = table.damping = 0.0;
    table.law = ForceLaw{Polyline({-1.0, 0.3, 2.0}, {-30.0, 9.0, 60.0}), Polyline({-3.0, 3.0}, {-12.0, 12.0})};
    (trial % 2 == 0 ? linear.preload : linear.free_length) = 0.7;
    (trial % 2 == 0 ? table.preload : table.free_length) = 0.7;
    const SpringGeometry a = spring_geometry(linear, Frame(), Frame()), b = spring_geometry(table, Frame(), Frame());
    EXPECT_LT((spring_force(a, first, second) - spring_force(b, first, second)).norm(), 1e-12);
    EXPECT_NEAR(spring_tension(a, first, second), spring_tension(b, first, second), 1e-12);
    EXPECT_NEAR(spring_strain_energy(a, first, second), spring_strain_energy(b, first, second), 1e-12);
    EXPECT_NEAR(spring_dissipation(a, first, second), spring_dissipation(b, first, second), 1e-12);
    PairMatrix a_q, a_qd, b_q, b_qd;
    spring_derivatives(a, first, second, a_q, a_qd);
    spring_derivatives(b, first, second, b_q, b_qd);
    EXPECT_LT((a_q - b_q).norm() + (a_qd - b_qd).norm(), 1e-11);
  }
}

/// Two free bodies with a spring and a torsion spring that have laws.
MechanismModel with_laws(double gap, Side side) {
  MechanismModel model;
  model.name = "laws";
  model.bodies = {make_body("a", 2.0, 0.5, 0.1, 0.2, 0.3), make_body("b", 1.0, 0.2, 1.0, 0.1, -0.2)};
  model.springs = {make_spring("s", 0, 1, {0.1, 0.3}, {1.2, 0.4}, 0.0)};
  model.springs[0].law = rich_law(gap, side);
  model.torsion_springs = {{"t", {0, 1}, 0.0, 0.0, 0.1, rich_law(gap, side)}};
  return model;
}

TEST(MechanismWithLaws, ForceDerivativesMatchDifferences) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-0.6, 0.6);
  for (const double gap : {0.0, 0.05})
    for (const Side side : sides) {
      Motion motion(with_laws(gap, side));
      int compared = 0;
      for (int trial = 0; trial < 20; ++trial) {
        Eigen::VectorXd q = motion.state.q, qd(6);
        for (int i = 0; i < 6; ++i) {
          q[i] = motion.mechanism.model().bodies[i / 3].position[i % 3] + number(random);
          qd[i] = number(random);
        }
        const auto force = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& rate) {
          motion.mechanism.set_positions(motion.state, 0.0, at.data());
          motion.mechanism.set_velocities(motion.state, 0.0, rate.data());
          motion.mechanism.compute_forces(motion.state);
          return motion.state.g;
        };
        force(q, qd);
        Eigen::MatrixXd g_q, g_qd;  // without joints B is the identity
        motion.mechanism.multiply_tangent(motion.state, 1.0, 0.0, 0.0, g_q);
        motion.mechanism.multiply_tangent(motion.state, 0.0, 1.0, 0.0, g_qd);
        for (int j = 0; j < 6; ++j) {
          const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(6, j);
          const Eigen::VectorXd by_q = (force(q + step, qd) - force(q - step, qd)) / 2e-6;
          const Eigen::VectorXd by_qd = (force(q, qd + step) - force(q, qd - step)) / 2e-6;
          compared += (g_q.col(j) - by_q).norm() < 1e-6 && (g_qd.col(j) - by_qd).norm() < 1e-6 ? 1 : 0;
        }
      }
      EXPECT_GE(compared, 119) << "of 120, one may straddle a corner";
    }
}

/// What does not balance after a second, over what the dampers took.
double unbalanced(double gap, Side side) {
  MechanismModel model = with_laws(gap, side);
  model.gravity = 0.0;
  model.bodies[0].velocity = (side == Side::tension ? -1.0 : 1.0) * Eigen::Vector3d(1.0, -0.5, 2.0);
  Motion motion(model);
  motion.finish();
  const double start = motion.total_energy(), h = 5e-5;
  double lost = 0.0;
  for (int i = 0; i < 20000; ++i) {
    lost += 0.5 * h * motion.mechanism.energy(motion.state).dissipation;
    motion.step(h);
    motion.finish();
    lost += 0.5 * h * motion.mechanism.energy(motion.state).dissipation;
  }
  EXPECT_GT(lost, 0.02 * start);
  return std::abs(motion.total_energy() + lost - start) / lost;
}

TEST(MechanismWithLaws, TwoBodiesLoseWhatTheDampersTake) {
  EXPECT_LT(unbalanced(0.0, Side::both), 1e-5);
  // a damper that comes on inside a step leaves its power times a part of the step
  for (const Side side : sides) EXPECT_LT(unbalanced(0.05, side), 3e-3);
}

TEST(MechanismWithLaws, ReportsItsForces) {
  MechanismModel model = with_laws(0.0, Side::both);
  model.springs[0].preload = 40.0;
  Motion motion(model);
  motion.finish();
  EXPECT_NEAR(motion.mechanism.spring_tension(motion.state, 0), 40.0, 1e-12);
  EXPECT_NEAR(motion.mechanism.torsion_spring_moment(motion.state, 0),
              -base::tension(*model.torsion_springs[0].law, -0.2 - 0.3 - 0.1, 0.0).tension, 1e-12);
}

TEST(MechanismWithLaws, Refusals) {
  const auto refused = [](const ForceLaw& law, std::optional<double> preload = {}, double stiffness = 0.0) {
    return message_of([&] {
      MechanismModel model = with_laws(0.0, Side::both);
      model.springs[0].law = law;
      model.springs[0].preload = preload;
      model.springs[0].stiffness = stiffness;
      Mechanism mechanism(model);
    });
  };
  MechanismModel preloaded = with_laws(0.0, Side::both);
  preloaded.springs[0].law = ForceLaw{Polyline({-1.0, 1.0}, {0.0, 2.0})};
  EXPECT_NO_THROW(Mechanism{preloaded});
  const Polyline falling({-1.0, 1.0}, {1.0, -1.0}), shifted({-1.0, 1.0}, {0.0, 2.0});
  EXPECT_PRED2(contains, refused({Polyline::line(1.0), falling}), "opposite signs");
  EXPECT_PRED2(contains, refused({shifted, Polyline::line(0.0), 0.1}), "it has 1 at 0");
  EXPECT_PRED2(contains, refused({Polyline::line(1.0), Polyline::line(0.0), -0.1}), "gap must not be negative");
  EXPECT_PRED2(contains, refused({Polyline::line(1.0)}, {}, 3.0), "not both");
  EXPECT_PRED2(contains, refused({Polyline::line(1.0), Polyline::line(0.0), 0.0, Side::tension}, -2.0), "free_length");
}

}  // namespace
}  // namespace traverse::multibody::testing
