// Contact of two bodies: its directions against differences of the definitions, action and reaction; the laws of
// impacts against integrations of the impact.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <vector>

#include "traverse/contact/body_contact.hpp"

namespace traverse::contact {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using multibody::Frame;

struct Motion {
  Vector3d q, qd;  // x, y, phi
};

Motion at(const Vector3d& q) { return {q, Vector3d::Zero()}; }

Frame frame(const Motion& motion) {
  Frame f;
  const Vector3d& q = motion.q;
  f.origin = q.head<2>();
  f.velocity = motion.qd.head<2>();
  f.set_angle(q.z());
  f.omega = motion.qd.z();
  return f;
}

/// A contact with the places of its two bodies at t = 0 and now.
struct Case {
  const char* name;
  BodyContact contact;
  Motion first, second;
  PairGeometry geometry() const { return pair_geometry(contact, frame(at(first_start)), frame(at(second_start))); }
  Vector3d first_start = {0.3, -0.2, 0.4}, second_start = {-0.1, 0.5, -0.7};
};

BodyContact arcs(double radius, double other, const Vector2d& centre, const Vector2d& other_centre) {
  BodyContact c;
  c.radii = {radius, other};
  c.centres = {centre, other_centre};
  return c;
}

BodyContact on_line(double radius, const Vector2d& centre, const Vector2d& begin, const Vector2d& end) {
  BodyContact c;
  c.type = PairType::arc_line;
  c.radii = {radius, 0.0};
  c.centres[0] = centre;
  c.line = {begin, end};
  return c;
}

// Places now: those at the start, moved a little, with some velocity.
Case make(const char* name, const BodyContact& contact) {
  Case c{name, contact, {}, {}};
  c.first = {c.first_start + Vector3d(0.02, -0.03, 0.05), {0.7, -1.1, 2.3}};
  c.second = {c.second_start + Vector3d(-0.01, 0.02, -0.04), {-0.4, 0.6, -1.7}};
  return c;
}

std::vector<Case> cases() {
  const Vector2d begin(-1.0, 0.2), end(2.0, 1.1), along = (end - begin).normalized(), left(-along.y(), along.x());
  return {make("convex", arcs(0.4, 0.7, {0.5, -0.1}, {-0.3, 0.4})),
          make("convex, apart", arcs(0.1, 0.2, {0.5, -0.1}, {-0.3, 0.4})),
          make("in a hollow arc", arcs(0.4, -0.9, {0.5, -0.1}, {0.15, 0.2})),
          make("hollow arc first", arcs(-0.9, 0.4, {0.5, -0.1}, {0.15, 0.2})),
          make("left of the line", on_line(0.35, begin + 1.3 * along + 0.3 * left, begin, end)),
          make("right of the line", on_line(0.35, begin + 1.3 * along - 0.3 * left, begin, end)),
          make("before the line", on_line(0.35, begin - 0.3 * along + 0.1 * left, begin, end)),
          make("behind the line", on_line(0.35, end + 0.3 * along - 0.1 * left, begin, end))};
}

PairTouch touched(const Case& c, const Motion& first, const Motion& second) {
  PairTouch out;
  EXPECT_TRUE(touch(c.geometry(), frame(first), frame(second), out)) << c.name;
  return out;
}

/// Where the point of a body that is now at `point` is h later.
Vector2d carried(const Motion& motion, const Vector2d& point, double h) {
  return motion.q.head<2>() + h * motion.qd.head<2>() +
         Eigen::Rotation2Dd(h * motion.qd.z()) * (point - motion.q.head<2>());
}

TEST(BodyContact, NormalsAreTheDerivativesOfThePenetration) {
  const double h = 1e-6;
  for (const Case& c : cases()) {
    const PairTouch out = touched(c, c.first, c.second);
    for (std::size_t body = 0; body < 2; ++body)
      for (int i = 0; i < 3; ++i) {
        std::array<double, 2> alpha{};
        for (std::size_t side = 0; side < 2; ++side) {
          std::array<Motion, 2> moved = {c.first, c.second};
          moved[body].q[i] += side == 0 ? -h : h;
          alpha[side] = touched(c, moved[0], moved[1]).kinematics.penetration;
        }
        EXPECT_NEAR(out.normal[body][i], (alpha[1] - alpha[0]) / (2.0 * h), 2e-9) << c.name << ' ' << body << i;
      }
    const double later =
        touched(c, at(c.first.q + h * c.first.qd), at(c.second.q + h * c.second.qd)).kinematics.penetration;
    const double before =
        touched(c, at(c.first.q - h * c.first.qd), at(c.second.q - h * c.second.qd)).kinematics.penetration;
    EXPECT_NEAR(out.kinematics.penetration_rate, (later - before) / (2.0 * h), 1e-8) << c.name;
  }
}

// The sliding speed is the velocity of the first body's point at the contact against the second body's, along the
// normal turned clockwise.
TEST(BodyContact, TangentsAreTheDerivativesOfTheSlidingSpeed) {
  const double h = 1e-6;
  for (const Case& c : cases()) {
    const PairTouch out = touched(c, c.first, c.second);
    const Vector2d outward = -out.normal[0].head<2>();
    const Vector2d tau(outward.y(), -outward.x());
    EXPECT_NEAR(tau.norm(), 1.0, 1e-14) << c.name;
    const auto sliding = [&](const Motion& first, const Motion& second) {
      const auto apart = [&](double s) -> Vector2d {
        return carried(first, out.point, s) - carried(second, out.point, s);
      };
      return tau.dot(apart(h) - apart(-h)) / (2.0 * h);
    };
    EXPECT_NEAR(out.kinematics.sliding_speed, sliding(c.first, c.second), 1e-8) << c.name;
    for (std::size_t body = 0; body < 2; ++body)
      for (int i = 0; i < 3; ++i) {
        std::array<Motion, 2> predicted = {at(c.first.q), at(c.second.q)};
        predicted[body].qd[i] = 1.0;
        EXPECT_NEAR(out.tangent[body][i], sliding(predicted[0], predicted[1]), 1e-8) << c.name << ' ' << body << i;
      }
  }
}

TEST(BodyContact, ThePointLiesHalfwayBetweenTheSurfaces) {
  for (const Case& c : cases()) {
    const PairTouch out = touched(c, c.first, c.second);
    const Motion start{c.first_start, c.first.q - c.first_start};  // moved there within 1 s
    const Vector2d centre = carried(start, c.contact.centres[0], 1.0);
    const double deep =
        (c.contact.radii[0] > 0.0 ? 1.0 : -1.0) * (std::abs(c.contact.radii[0]) - (out.point - centre).norm());
    EXPECT_NEAR(deep, 0.5 * out.kinematics.penetration, 1e-14) << c.name;
  }
}

TEST(BodyContact, ActionAndReaction) {
  for (const Case& c : cases()) {
    const PairTouch out = touched(c, c.first, c.second);
    const double normal = 1.3e5, tangential = -4.1e4;
    Vector3d total = Vector3d::Zero();  // with the moment about the frame's origin
    double size = 0.0;
    for (std::size_t body = 0; body < 2; ++body) {
      const Vector3d f = -normal * out.normal[body] - tangential * out.tangent[body];
      const Vector3d& q = body == 0 ? c.first.q : c.second.q;
      total += f + Vector3d(0.0, 0.0, q.x() * f.y() - q.y() * f.x());
      size += f.norm();
    }
    EXPECT_EQ(total.x(), 0.0) << c.name;
    EXPECT_EQ(total.y(), 0.0) << c.name;
    EXPECT_NEAR(total.z(), 0.0, 1e-15 * size) << c.name;
  }
}

TEST(BodyContact, AnArcDrivenThroughItsLineIsRefused) {
  const BodyContact contact = on_line(0.35, {0.5, 0.3}, {0.0, 0.0}, {1.0, 0.0});
  const Frame ground;
  PairGeometry pair = pair_geometry(contact, ground, ground);
  PairTouch out;
  const auto moved = [](double x, double y) { return frame(at({x, y, 0.0})); };
  EXPECT_TRUE(touch(pair, moved(0.0, -0.29), ground, out));
  EXPECT_NEAR(out.kinematics.penetration, 0.34, 1e-15);
  EXPECT_FALSE(touch(pair, moved(0.0, -0.31), ground, out));
  // round the end it may go, and then it is on the other side
  record_side(pair, moved(0.0, -0.31), ground);
  EXPECT_EQ(pair.side, 1.0);
  EXPECT_TRUE(touch(pair, moved(0.6, -0.31), ground, out));
  record_side(pair, moved(0.6, -0.31), ground);
  EXPECT_EQ(pair.side, -1.0);
  EXPECT_TRUE(touch(pair, moved(0.0, -0.6), ground, out));
  EXPECT_NEAR(out.kinematics.penetration, 0.05, 1e-15);
}

TEST(BodyContact, EffectiveRadius) {
  EXPECT_DOUBLE_EQ(effective_radius(arcs(0.4, 0.6, {0.0, 0.0}, {1.0, 0.0})), 0.24);
  EXPECT_DOUBLE_EQ(effective_radius(arcs(1.0, -2.0, {0.0, 0.0}, {1.0, 0.0})), 2.0);  // 1/R = 1/1 - 1/2
  EXPECT_DOUBLE_EQ(effective_radius(on_line(0.4, {0.0, 0.4}, {0.0, 0.0}, {1.0, 0.0})), 0.4);
}

// --- impacts ---------------------------------------------------------------------------------------------------------

/// An impact of 1 kg that meets the law at speed v: how long it lasts and how it leaves.
struct Rebound {
  double duration, speed;
};
Rebound rebound(const Law& law, double v, double h) {
  Vector2d y(0.0, v);
  const auto rate = [&](const Vector2d& s) { return Vector2d(s[1], -force(law, {s[0], s[1], 0.0}, v).normal); };
  for (long i = 1;; ++i) {
    const double before = y[0];
    const Vector2d a = rate(y), b = rate(y + 0.5 * h * a), c = rate(y + 0.5 * h * b), d = rate(y + h * c);
    y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    if (y[0] <= 0.0) return {h * (static_cast<double>(i - 1) + before / (before - y[0])), -y[1]};
    if (i > 20'000'000) return {-1.0, -1.0};
  }
}

Law impact(LawKind kind, double hysteresis) {
  Law law;
  law.kind = kind;
  law.stiffness = 1.0;
  law.hysteresis = hysteresis;
  return law;
}

TEST(Impact, TheExactHysteresisRebounds) {
  for (LawKind kind : {LawKind::hertz, LawKind::linear})
    for (double e : {0.05, 0.2, 0.5, 0.8, 0.95, 1.0})
      for (double v : {0.3, 2.0})
        EXPECT_NEAR(rebound(impact(kind, exact_hysteresis(e)), v, 1e-3).speed, e * v, 2e-6 * v) << e;
}

// The rebound that a hysteresis d leads to solves (1 + e) d = ln((1 + d)/(1 - e d)).
TEST(Impact, LankaraniAndNikraveshReboundMore) {
  for (double asked : {0.2, 0.5, 0.9}) {
    const double d = lankarani_nikravesh_hysteresis(asked);
    EXPECT_DOUBLE_EQ(d, 0.75 * (1.0 - asked * asked));
    const double e = rebound(impact(LawKind::hertz, d), 1.0, 1e-3).speed;
    EXPECT_GT(e, asked);
    EXPECT_NEAR((1.0 + e) * d, std::log((1.0 + d) / (1.0 - e * d)), 1e-5);
  }
  EXPECT_NEAR(exact_hysteresis(0.999) / lankarani_nikravesh_hysteresis(0.999), 1.0, 2e-3) << "the same near 1";
}

TEST(Impact, DurationIsThatOfTheElasticImpact) {
  for (LawKind kind : {LawKind::hertz, LawKind::linear})
    for (double v : {0.1, 1.0}) {
      const double expected = impact_duration(impact(kind, 0.0), 1.0, v);
      EXPECT_NEAR(rebound(impact(kind, 0.0), v, 1e-3).duration, expected, 1e-6 * expected);
    }
  Law stiff = impact(LawKind::hertz, 0.0);
  stiff.stiffness = 1e10;
  const double greatest = std::pow(1.25 * 3.0 * 4.0 / 1e10, 0.4);  // 3 kg at 2 m/s
  EXPECT_NEAR(impact_duration(stiff, 3.0, 2.0), 2.9432 * greatest / 2.0, 1e-4 * greatest);
}

}  // namespace
}  // namespace traverse::contact
