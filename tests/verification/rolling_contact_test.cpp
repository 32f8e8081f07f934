// Rolling and sliding under tanh friction against closed forms, with the creep that the tanh leaves.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/separations.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

constexpr double gravity = 9.81;

/// A disc of 2 kg and 0.25 m that stands on a line at `slope` (rad) to the left of the origin, moving down it.
struct Disc {
  double slope = 0.0, friction = 0.3, transition = 1e-3, speed = 0.0, time = 1.0;
  bool held = false;  // from turning
};
constexpr double disc_mass = 2.0, disc_radius = 0.25, disc_stiffness = 1e8;

Results run_disc(const Disc& d) {
  const double c = std::cos(d.slope), s = std::sin(d.slope),
               high = disc_radius - disc_mass * gravity * c / disc_stiffness;
  const std::string place = text(s * high) + ", " + text(c * high);
  const auto end = [&](double along) { return text(c * along) + ", " + text(-s * along); };
  return run_yaml(
      "vehicle:\n  disc:\n    bodies: [disc]\n    contacts: [ground_line]\n" +
      std::string(d.held ? "    drivers: [level]\n    level: {body: disc, coordinate: phi}\n" : "") +
      "    disc: {mass: 2.0, inertia: 0.0625, position: [" + place + "], velocity: [" + text(c * d.speed) + ", " +
      text(-s * d.speed) + ", 0.0]}\n    ground_line: {type: arc_line, bodies: [disc, ground], " +
      "radii: 0.25, centres: [" + place + "], line: [" + end(-1.0) + ", " + end(20.0) +
      "], law: linear, stiffness: 1.0e8, friction: " + text(d.friction) + ", transition_speed: " + text(d.transition) +
      "}\nscene: {start: given}\nts: {max_time: " + text(d.time) + ", dt: 1.0e-3}\noutput: {interval: 0.05}\n");
}

/// Speed and distance down the line at every sample, and how fast it turns with it.
struct Descent {
  std::vector<double> speed, distance, rolling;
};
Descent descent(Results& run, const Disc& d) {
  Descent out;
  const double c = std::cos(d.slope), s = std::sin(d.slope);
  const double arm = disc_radius - 0.5 * disc_mass * gravity * c / disc_stiffness;  // halfway into the line
  const std::vector<double>&q = run("/vehicles/0/disc/position"), &v = run("/vehicles/0/disc/velocity");
  for (std::size_t i = 0; i < run.time().size(); ++i) {
    out.speed.push_back(c * v[3 * i] - s * v[3 * i + 1]);
    out.distance.push_back(c * (q[3 * i] - q[0]) - s * (q[3 * i + 1] - q[1]));
    out.rolling.push_back(-arm * v[3 * i + 2]);
  }
  return out;
}

// Regularised friction f = mu N tanh(s/vt) holds by creeping at s = vt artanh(tan(slope)/(3 mu)). As v + r w/2 gains
// g sin(slope) a second whatever the friction, v = (2/3) g sin(slope) t + s/3.
TEST(Disc, RollsDownAnIncline) {
  const Disc d{.slope = 0.3};
  Results run = run_disc(d);
  const Descent seen = descent(run, d);
  const double creep = d.transition * std::atanh(std::tan(d.slope) / (3.0 * d.friction));
  const double pull = gravity * std::sin(d.slope), t = run.time().back();
  RecordProperty("speed_error", text(seen.speed.back() - (2.0 / 3.0 * pull * t + creep / 3.0)));
  RecordProperty("creep_error", text((seen.speed.back() - seen.rolling.back()) / creep - 1.0));
  EXPECT_NEAR(seen.speed.back() - seen.rolling.back(), creep, 1e-5 * creep);
  EXPECT_NEAR(seen.speed.back(), 2.0 / 3.0 * pull * t + creep / 3.0, 1e-6 * pull * t);
  EXPECT_NEAR(seen.distance.back(), pull * t * t / 3.0 + creep * t / 3.0, 1e-5 * pull * t * t);
  EXPECT_LT(energy_error(run), 1e-5);
}

// Where mu < tan(slope)/3 it slides at g (sin - mu cos). While friction builds up, over s from 0 on at a rate of at
// least g (sin - 3 mu cos), it lacks the integral of mu g cos (1 - tanh(s/vt)), which is below mu g cos vt ln 2 over
// that rate.
TEST(Disc, SlidesDownASteepIncline) {
  const Disc d{.slope = 0.6, .friction = 0.15};
  Results run = run_disc(d);
  const Descent seen = descent(run, d);
  const double grip = d.friction * gravity * std::cos(d.slope), pull = gravity * std::sin(d.slope);
  const double t = run.time().back(), late = grip * d.transition * std::log(2.0) / (pull - 3.0 * grip);
  ASSERT_GT(pull, 3.0 * grip);
  RecordProperty("speed_ahead", text(seen.speed.back() - (pull - grip) * t));
  RecordProperty("bound", text(late));
  EXPECT_GT(seen.speed.back() - (pull - grip) * t, 0.0);
  EXPECT_LT(seen.speed.back() - (pull - grip) * t, late);
  EXPECT_NEAR(seen.rolling.back(), 2.0 * grip * t, 2.0 * late);
  EXPECT_LT(energy_error(run), 1e-5);
}

// v' = -mu g tanh(v/vt) from v0: the distance is v0^2/(2 mu g) + (vt^2/(mu g)) pi^2/12.
TEST(SlidingBlock, StopsAfterItsDistance) {
  const Disc d{.transition = 0.05, .speed = 2.0, .time = 1.5, .held = true};
  Results run = run_disc(d);
  const Descent seen = descent(run, d);
  const double braking = d.friction * gravity, ideal = 0.5 * d.speed * d.speed / braking;
  const double correction = d.transition * d.transition / braking * pi * pi / 12.0;
  // what is left: sinh(v/vt) = sinh(v0/vt) exp(-mu g t/vt)
  const double left = d.transition * std::exp(d.speed / d.transition - braking * d.time / d.transition);
  RecordProperty("error", text(seen.distance.back() - ideal - correction));
  RecordProperty("correction", text(correction));
  EXPECT_NEAR(seen.distance.back(), ideal + correction, 1e-6 * ideal);
  EXPECT_NEAR(seen.speed.back(), 0.0, left + 1e-9);
  EXPECT_LT(energy_error(run), 1e-5);
}

// v + r w/2 stays: a disc that is thrown without turning ends rolling at 2/3 of its speed, after v0/(3 mu g).
TEST(BowlingBall, SlidesThenRolls) {
  const Disc d{.speed = 3.0, .time = 1.0};
  Results run = run_disc(d);
  const Descent seen = descent(run, d);
  const std::vector<double> t = run.time();
  const double grip = d.friction * gravity, rolls_from = d.speed / (3.0 * grip);
  double worst = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i)
    if (std::abs(t[i] - rolls_from) > 0.01)
      worst =
          std::max(worst, std::abs(seen.speed[i] - (t[i] < rolls_from ? d.speed - grip * t[i] : 2.0 / 3.0 * d.speed)));
  RecordProperty("speed_error", text(worst / d.speed));
  EXPECT_LT(worst, 1e-5 * d.speed);
  EXPECT_NEAR(seen.rolling.back(), seen.speed.back(), 1e-5 * d.speed);
  EXPECT_LT(energy_error(run), 1e-4);
}

}  // namespace
}  // namespace traverse::test
