// Contact laws: derivatives against differences, one-sidedness, energy, eq. 48.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <numbers>
#include <string>

#include "support/folders.hpp"
#include "traverse/contact/law.hpp"

namespace traverse::contact {
namespace {

Law hertz() {
  Law law;
  law.stiffness = 9.4e10;
  law.damping = 1.0e5;
  law.friction = 0.3;
  law.transition_speed = 0.02;
  return law;
}

Law linear() {
  Law law = hertz();
  law.kind = LawKind::linear;
  law.stiffness = 1.6e6;
  return law;
}

Law impact() {
  Law law = hertz();
  law.hysteresis = lankarani_nikravesh_hysteresis(0.6);
  return law;
}

Law on_a_seat(Law law) {
  law.local_compliance = 0.3 / (law.kind == LawKind::linear ? law.stiffness : 1e9);
  return law;
}

/// Hertz's law as a program outside would write it.
class WrittenHertz : public ElasticLaw {
 public:
  double force(double a) const override { return 9.4e10 * std::pow(a, 1.5); }
  double stiffness(double a) const override { return 1.5 * 9.4e10 * std::sqrt(a); }
  double energy(double a) const override { return 0.4 * 9.4e10 * std::pow(a, 2.5); }
};

Law other() {
  Law law = hertz();
  law.kind = LawKind::other;
  law.elastic = std::make_shared<WrittenHertz>();
  law.stiffness = 0.0;
  return law;
}

void expect_derivatives(const Law& law, const Kinematics& k, double approach) {
  const double da = 1e-6 * k.penetration, dr = 1e-6, ds = 1e-7;
  const Force f = force(law, k, approach);
  ASSERT_GT(f.normal, 0.0);
  auto difference = [&](double a, double r, double s) {
    const Force p = force(law, {k.penetration + a, k.penetration_rate + r, k.sliding_speed + s}, approach);
    const Force m = force(law, {k.penetration - a, k.penetration_rate - r, k.sliding_speed - s}, approach);
    const double step = 2.0 * (a + r + s);
    return std::pair{(p.normal - m.normal) / step, (p.tangential - m.tangential) / step};
  };
  auto near = [](double a, double b, double scale) { EXPECT_NEAR(a, b, 1e-6 * scale + 1e-6 * std::abs(b)); };
  near(f.normal_by_penetration, difference(da, 0, 0).first, 0.0);
  near(f.normal_by_rate, difference(0, dr, 0).first, 1.0);
  near(0.0, difference(0, 0, ds).first, 1.0);
  near(f.tangential_by_penetration, difference(da, 0, 0).second, 0.0);
  near(f.tangential_by_rate, difference(0, dr, 0).second, 1.0);
  near(f.tangential_by_sliding, difference(0, 0, ds).second, 0.0);
}

// --- the table of laws

TEST(ContactLaws, AreReadByTheirNames) {
  for (const LawRow& row : law_rows) {
    if (row.name.empty()) continue;
    EXPECT_EQ(law_kind(row.name), row.kind);
    EXPECT_FALSE(row.words.empty());
  }
  EXPECT_FALSE(law_kind("").has_value());
  EXPECT_FALSE(law_kind("other").has_value());
}

TEST(ContactLaws, AreInTheGuide) {
  std::ifstream file(source_folder() + "/doc/guide/contacts.md");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  for (const LawRow& row : law_rows)
    EXPECT_TRUE(row.name.empty() || text.find("`law: " + std::string(row.name) + "`") != std::string::npos) << row.name;
}

// The slope of the force, its integral and its inverse belong to each other, whatever the law.
TEST(ContactLaws, EachIsConsistent) {
  for (const LawRow& row : law_rows) {
    if (row.name.empty()) continue;
    Law law;
    law.kind = row.kind;
    law.stiffness = 3.0e8;
    for (const double compliance : {0.0, 2.0e-9}) {
      law.local_compliance = compliance;
      const double alpha = 2.0e-4, d = 1e-8;
      const auto at = [&](double penetration) { return force(law, {penetration, 0.0, 0.0}, 0.0); };
      const Force f = at(alpha);
      EXPECT_NEAR(f.normal_by_penetration, (at(alpha + d).normal - at(alpha - d).normal) / (2.0 * d),
                  1e-6 * f.normal_by_penetration)
          << row.name;
      EXPECT_NEAR(f.normal, (potential(law, alpha + d) - potential(law, alpha - d)) / (2.0 * d), 1e-6 * f.normal)
          << row.name;
      EXPECT_NEAR(static_penetration(law, f.normal), surface_penetration(law, alpha), 1e-9 * alpha) << row.name;
    }
    law.local_compliance = 0.0;
    EXPECT_GT(impact_duration(law, 1000.0, 0.1), 0.0) << row.name;
    EXPECT_EQ(force(law, {-1e-4, 0.0, 0.0}, 0.0).normal < 0.0, row.pulls) << row.name;
  }
}

TEST(ContactLaw, DerivativesMatchDifferences) {
  const Kinematics k{1.2e-4, 0.013, 0.015};
  expect_derivatives(hertz(), k, 0.0);
  expect_derivatives(linear(), k, 0.0);
  expect_derivatives(impact(), k, 0.2);
  expect_derivatives(impact(), {1.2e-4, -0.1, -0.03}, 0.2);
  for (const Law& law : {hertz(), linear(), impact()}) expect_derivatives(on_a_seat(law), k, 0.2);
}

TEST(ContactLaw, OfAProgramIsUsedAsHertz) {
  expect_derivatives(other(), {1.2e-4, 0.013, 0.015}, 0.0);
  for (const double local_compliance : {0.0, 3e-10}) {
    Law written = other(), built_in = hertz();
    written.local_compliance = built_in.local_compliance = local_compliance;
    const auto near = [](double a, double b) { EXPECT_NEAR(a, b, 1e-10 * std::abs(b)); };
    for (const double alpha : {2e-6, 1.2e-4, 3e-3}) {
      const Force a = force(written, {alpha, 0.01, 0.02}, 0.0), b = force(built_in, {alpha, 0.01, 0.02}, 0.0);
      near(a.normal, b.normal);
      near(a.normal_by_penetration, b.normal_by_penetration);
      near(a.tangential, b.tangential);
      near(surface_penetration(written, alpha), surface_penetration(built_in, alpha));
      near(potential(written, alpha), potential(built_in, alpha));
    }
    near(static_penetration(written, 66217.5), static_penetration(built_in, 66217.5));
  }
  const double exact = impact_duration(hertz(), 300.0, 0.4);
  EXPECT_NEAR(impact_duration(other(), 300.0, 0.4), exact, 1e-5 * exact);
}

// In series: the law at its own part of the penetration, the seat at the rest.
TEST(ContactLaw, SharesThePenetrationWithItsSeat) {
  for (Law law : {hertz(), linear()}) {
    law.damping = 0.0;
    const Law seated = on_a_seat(law);
    for (const double penetration : {1e-9, 2e-5, 1.2e-4, 3e-3}) {
      const double normal = force(seated, {penetration, 0.0, 0.0}, 0.0).normal;
      const double own = penetration - seated.local_compliance * normal;
      EXPECT_NEAR(normal, force(law, {own, 0.0, 0.0}, 0.0).normal, 1e-12 * normal);
      EXPECT_NEAR(surface_penetration(seated, penetration), own, 1e-12 * penetration);
      EXPECT_LT(own, penetration);
      const double stored = potential(law, own) + 0.5 * seated.local_compliance * normal * normal;
      EXPECT_NEAR(potential(seated, penetration), stored, 1e-12 * stored);
    }
  }
}

TEST(ContactLaw, NeverPulls) {
  for (const Law& law : {hertz(), linear(), impact()}) {
    for (double alpha : {-1.0, -1e-9, 0.0, 1e-9, 1e-5, 1e-3}) {
      for (double rate : {-10.0, -0.1, 0.0, 0.1}) {
        const Force f = force(law, {alpha, rate, 0.1}, 0.05);
        EXPECT_GE(f.normal, 0.0);
        if (alpha <= 0.0) {
          EXPECT_EQ(f.normal, 0.0);
          EXPECT_EQ(f.tangential, 0.0);
          EXPECT_EQ(f.normal_by_penetration, 0.0);
        }
      }
    }
  }
  EXPECT_EQ(force(hertz(), {1e-6, -10.0, 0.0}, 0.0).normal, 0.0) << "a separating damper must not stick";
}

TEST(ContactLaw, PotentialIsTheIntegralOfTheForce) {
  for (Law law : {hertz(), linear()}) {
    law.damping = 0.0;
    const double alpha = 2.3e-4;
    // dP/dalpha = force, and P(0) = 0
    const double d = 1e-7 * alpha;
    const double slope = (potential(law, alpha + d) - potential(law, alpha - d)) / (2.0 * d);
    EXPECT_NEAR(slope, force(law, {alpha, 0.0, 0.0}, 0.0).normal, 1e-6 * slope);
    EXPECT_EQ(potential(law, 0.0), 0.0);
    EXPECT_EQ(potential(law, -1.0), 0.0);
  }
}

TEST(ContactLaw, PenetrationAtRestInvertsTheForce) {
  for (const Law& law : {hertz(), linear(), impact()}) {
    const double alpha = static_penetration(law, 66217.5);
    EXPECT_NEAR(force(law, {alpha, 0.0, 0.0}, 0.0).normal, 66217.5, 1e-9 * 66217.5);
    EXPECT_EQ(static_penetration(law, 0.0), 0.0);
  }
  // reference/R4.csv, first line: F = (delta/9.1e-8)^1.5 under 66217.5 N
  Law r4;
  r4.stiffness = std::pow(9.1e-8, -1.5);
  EXPECT_NEAR(static_penetration(r4, 66217.5), 1.489440799e-4, 1e-12);
}

TEST(ContactLaw, FrictionActsWithTheSlidingSpeedAndSaturates) {
  const Force slow = force(hertz(), {1e-4, 0.0, 0.0}, 0.0);
  const Force fast = force(hertz(), {1e-4, 0.0, 1.0}, 0.0);
  const Force back = force(hertz(), {1e-4, 0.0, -1.0}, 0.0);
  EXPECT_EQ(slow.tangential, 0.0);
  EXPECT_NEAR(fast.tangential, 0.3 * fast.normal, 1e-9 * fast.normal);
  EXPECT_EQ(back.tangential, -fast.tangential);
}

// A mass hits the contact at 0.3 m/s. Lankarani and Nikravesh's law is derived for e near 1: the rebound follows e
// to second order in 1 - e.
double rebound(double e) {
  Law law = impact();
  law.hysteresis = lankarani_nikravesh_hysteresis(e);
  const double mass = 1000.0, v0 = 0.3, dt = 2e-7;
  double a = 0.0, v = v0;  // penetration and its rate; semi-implicit Euler
  do {
    v -= dt * force(law, {a, v, 0.0}, v0).normal / mass;
    a += dt * v;
  } while (a > 0.0);
  return -v / v0;
}

TEST(ContactLaw, RestitutionGivesTheRebound) {
  EXPECT_NEAR(rebound(1.0), 1.0, 1e-4);
  const double coarse = rebound(0.9) - 0.9, fine = rebound(0.95) - 0.95;
  EXPECT_LT(std::abs(coarse), 1.5 * 0.1 * 0.1);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);
}

TEST(ContactLaw, WithoutAnImpactTheRestitutionIsElastic) {
  EXPECT_EQ(force(impact(), {1e-4, 0.5, 0.0}, 0.0).normal, force(impact(), {1e-4, 0.0, 0.0}, 0.0).normal);
}

TEST(HertzStiffness, SteelOnSteel) {
  // Equal materials: k = 2 E sqrt(R) / (3 (1 - nu^2)), from eq. 48 by hand.
  const double E = 2.1e11, nu = 0.3, R = 0.46;
  EXPECT_NEAR(hertz_stiffness(R, E, nu, E, nu), 2.0 * E * std::sqrt(R) / (3.0 * (1.0 - nu * nu)), 1.0);
  EXPECT_GT(hertz_stiffness(R, E, nu, E, nu), hertz_stiffness(R, E, nu, 0.5 * E, nu));
}

}  // namespace
}  // namespace traverse::contact
