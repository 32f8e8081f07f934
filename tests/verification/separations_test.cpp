// Contacts lost and met again over a bump: when, against much shorter steps and against an integration of the wheel's
// two degrees of freedom; and what the list of separations says of flights that are no losses.
#include "support/separations.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

/// The largest differences of starts and ends, s; the same number of separations.
double time_difference(const std::vector<Separated>& a, const std::vector<Separated>& b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max({worst, std::abs(a[i].start - b[i].start), std::abs(a[i].end() - b[i].end())});
  return worst;
}
double force_difference(const std::vector<Separated>& a, const std::vector<Separated>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (b[i].approach_speed > 0.0) worst = std::max(worst, std::abs(a[i].impact_force / b[i].impact_force - 1.0));
  return worst;
}

// --- on a bridge -----------------------------------------------------------------------------------------------------

void expect_losses(const Values& wheel, std::size_t losses) {
  const std::string name = wheel.empty() ? "" : "restitution_";
  Results run = run_scene("wheel_over_a_bump", wheel);
  Results fine = run_scene("wheel_over_a_bump", wheel + Values{{"ts_dt", "5e-5"}});
  const std::vector<Separated> seen = separations(run), exact = separations(fine);
  testing::Test::RecordProperty(name + "time_difference", text(time_difference(seen, exact)));
  testing::Test::RecordProperty(name + "force_difference", text(force_difference(seen, exact)));
  ASSERT_EQ(seen.size(), losses);
  EXPECT_LT(time_difference(seen, exact), 1e-4);  // asked for: 3e-4
  EXPECT_LT(force_difference(seen, exact), 0.01);
  double longest = 0.0;
  for (const Separated& s : seen) {
    EXPECT_EQ(s.vehicle, "0");
    EXPECT_EQ(s.contact, "wheel");
    EXPECT_NEAR(s.x, 30.0 * s.start, 30.0 * 1e-4);
    EXPECT_GT(s.approach_speed, 0.0);
    longest = std::max(longest, s.duration);
  }
  EXPECT_EQ(run.attribute("/summary", "contact_losses"), static_cast<double>(losses));
  EXPECT_EQ(run.attribute("/summary", "longest_loss"), longest);
}

TEST(Separations, OverABumpOnABridge) { expect_losses({}, 4); }

TEST(Separations, OverABumpOnABridgeWithRestitution) {
  expect_losses(
      {{"track_bump_length", "1.0"}, {"track_bump_height", "0.01"}, {"vehicle_sprung_wheel_wheel_restitution", "0.5"}},
      2);
}

// --- on rigid ground -------------------------------------------------------------------------------------------------

// The wheel of the scene, without its bridge.
constexpr const char* rigid = R"(
vehicle:
  sprung_wheel:
    bodies:  [axle, body]
    joints:  [guide]
    springs: [suspension]
    drivers: [level]
    wheels:  [wheel]
    axle: {mass: 1000.0, inertia: 100.0, position: [0.0, 0.46]}
    body: {mass: 5750.0, inertia: 100.0, position: [0.0, 1.5]}
    guide: {type: prismatic, bodies: [axle, body], point: [0.0, 1.0], axis: [0.0, 1.0]}
    suspension: {bodies: [axle, body], from: [0.0, 0.46], to: [0.0, 1.5], stiffness: 1.595e6, damping: 2.0e4}
    level: {body: axle, coordinate: phi, value: 0.0}
    wheel: {body: axle, radius: 0.46, law: hertz, stiffness: 3.64e10}
train: {vehicles: sprung_wheel, positions: 0.0, speed: 30.0}
track: {profile: bump, bump: {start: 1.5, length: 1.0, height: 0.01}}
ts: {max_time: 0.3, dt: 1.0e-3}
output: {interval: 1.0e-3}
)";

/// Heights of axle and body over the same bump, by the classical Runge-Kutta method.
class SprungWheel {
 public:
  using State = Eigen::Vector4d;  // y1, y2, y1', y2'

  std::vector<Separated> run(double end, double h) {
    const double settled = std::pow((axle + body) * gravity / stiffness, 2.0 / 3.0);
    State y(radius - settled, radius - settled - body * gravity / spring, 0.0, 0.0);  // body: less its free height
    std::vector<Separated> list;
    double before = settled;
    for (long i = 0; static_cast<double>(i) * h < end; ++i) {
      const double t = static_cast<double>(i) * h;
      const State a = rate(t, y), b = rate(t + 0.5 * h, y + 0.5 * h * a), c = rate(t + 0.5 * h, y + 0.5 * h * b),
                  d = rate(t + h, y + h * c);
      y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
      const double now = penetration(t + h, y[0]).first;
      const double changed = t + h * before / (before - now);
      if (before > 0.0 && now <= 0.0) list.push_back({"0", "wheel", speed * changed, changed, 0.0, 0.0, 0.0});
      if (before <= 0.0 && now > 0.0) {
        list.back().duration = changed - list.back().start;
        list.back().approach_speed = (now - before) / h;
        compressing_ = true;
      }
      if (compressing_ && now > 0.0)
        list.back().impact_force = std::max(list.back().impact_force, stiffness * std::pow(now, 1.5));
      if (now < before) compressing_ = false;
      before = now;
    }
    if (before <= 0.0) list.back().duration = end - list.back().start;
    return list;
  }

 private:
  static constexpr double axle = 1000.0, body = 5750.0, gravity = 9.81, radius = 0.46, stiffness = 3.64e10;
  static constexpr double spring = 1.595e6, damper = 2.0e4, speed = 30.0;
  bool compressing_ = false;

  struct Height {
    double value, slope;
  };
  static Height track(double x) {
    if (x < 1.5 || x > 2.5) return {0.0, 0.0};
    return {0.005 * (1.0 - std::cos(2.0 * pi * (x - 1.5))), 0.01 * pi * std::sin(2.0 * pi * (x - 1.5))};
  }

  /// Of the wheel at a height, and the vertical component of the normal there.
  static std::pair<double, double> penetration(double t, double y) {
    const double x = speed * t;
    double s = x;  // of the nearest point: (s - x) + (h - y) h' = 0
    for (int i = 0; i < 30; ++i) {
      const auto [h, slope] = track(s);
      const double next = x + (y - h) * slope;
      if (std::abs(next - s) < 1e-14) break;
      s = next;
    }
    const auto [h, slope] = track(s);
    const double distance = std::hypot(s - x, y - h);
    return {radius - distance, (y - h) / distance};
  }

  static State rate(double t, const State& y) {
    const auto [alpha, upward] = penetration(t, y[0]);
    const double contact = alpha > 0.0 ? stiffness * std::pow(alpha, 1.5) * upward : 0.0;
    const double push = -spring * (y[1] - y[0]) - damper * (y[3] - y[2]);  // of the suspension, on the body
    return {y[2], y[3], (contact - push) / axle - gravity, push / body - gravity};
  }
};

TEST(Separations, OverABumpOnRigidGround) {
  Results run = run_yaml(rigid);
  const std::vector<Separated> seen = separations(run), exact = SprungWheel().run(run.time().back(), 2e-6);
  ASSERT_GE(exact.size(), 10u);
  ASSERT_EQ(seen.size(), exact.size());
  const double difference = time_difference(seen, exact);
  RecordProperty("losses", static_cast<int>(exact.size()));
  RecordProperty("time_error", text(difference));
  RecordProperty("force_error", text(force_difference(seen, exact)));
  EXPECT_LT(difference, 5e-5);
  EXPECT_LT(force_difference(seen, exact), 1e-3);
}

// --- what counts -----------------------------------------------------------------------------------------------------

TEST(Separations, NoneWhereTheWheelHolds) {
  Results run = run_yaml(rigid, {{"track_bump_height", "0.002"}});
  EXPECT_TRUE(separations(run).empty());
  EXPECT_EQ(run.attribute("/summary", "contact_losses"), 0.0);
}

// A flight from the start is no loss; one that has not ended counts until the end.
TEST(Separations, AFlightFromTheStartIsNoLoss) {
  Results run = run_yaml(
      rigid, {{"scene_start", "given"}, {"vehicle_sprung_wheel_axle_position", "0.0, 0.47"}, {"ts_max_time", "0.02"}});
  const std::vector<Separated> list = separations(run);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].start, 0.0);
  EXPECT_NEAR(list[0].duration, 0.02, 1e-15);
  EXPECT_EQ(list[0].approach_speed, 0.0);
  EXPECT_EQ(list[0].impact_force, 0.0);
  EXPECT_EQ(run.attribute("/summary", "contact_losses"), 0.0);
  EXPECT_EQ(run.attribute("/summary", "longest_loss"), 0.0);
}

}  // namespace
}  // namespace traverse::test
