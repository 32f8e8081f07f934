// Dry friction in sliding joints, run by the program: against an independent reduced equation, in the energy balance,
// in Newton's law of every body, by implicit and explicit methods, in free fall, and on a freight wagon.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/jet.hpp"
#include "support/message.hpp"
#include "support/newton_law.hpp"
#include "support/runge_kutta.hpp"

namespace traverse::test {
namespace {

using Eigen::Vector2d;

const Values explicit_method = {{"ts_type", "rk"}, {"ts_rk_type", "5dp"}};

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// options/scenes/slider_crank.yml reduced to the crank's angle, with friction mu on the guide's normal force, which
/// follows from the rod's balance of moments.
class RubbingCrank {
 public:
  RubbingCrank(double mu, double transition) : mu_(mu), transition_(transition) {}
  double acceleration(double theta, double rate) const {
    const Jet angle_of(theta, 1.0, 0.0), x = Jet(r) * cos(angle_of), y = Jet(r) * sin(angle_of);
    const Jet end = x + sqrt(Jet(l * l) - y * y), third(1.0 / 3.0), two_thirds(2.0 / 3.0);
    const Jet rod_x = two_thirds * x + third * end, rod_y = two_thirds * y, rod_phi = angle(Jet(0.0) - y, end - x);
    const Jet crank_x = third * x, crank_y = third * y;
    const double speed = end.first * rate;
    const double spring = -500.0 * (end.value - 0.36) - 20.0 * speed;  // on the slider
    double bent = 0.0, J = 0.02 + 0.015 * rod_phi.first * rod_phi.first;
    const auto add = [&](double mass, const Jet& at) {
      J += mass * at.first * at.first;
      bent += mass * at.first * at.second;
    };
    for (const Jet& at : {crank_x, crank_y}) add(2.0, at);
    for (const Jet& at : {rod_x, rod_y}) add(1.0, at);
    add(1.5, end);
    bent += 0.015 * rod_phi.first * rod_phi.second;
    const double Q = 12.0 + spring * end.first - g * (2.0 * crank_y.first + rod_y.first);
    double friction = 0.0, second = 0.0;
    for (int i = 0; i < 60; ++i) {
      second = (Q + friction * end.first - bent * rate * rate) / J;
      const auto total = [&](const Jet& at) { return at.first * second + at.second * rate * rate; };
      // the slider's force on the rod's end, from its own balance along x and the rod's of moments about the crank pin
      const double push = spring + friction - 1.5 * total(end);
      const Vector2d arm(end.value - x.value, -y.value), centre(rod_x.value - x.value, rod_y.value - y.value);
      const Vector2d inertia(total(rod_x), total(rod_y) + g);
      const double lift = (0.015 * total(rod_phi) + cross(centre, inertia) + arm.y() * push) / arm.x();
      friction = -mu_ * std::abs(lift + 1.5 * g) * std::tanh(speed / transition_);
    }
    return second;
  }

 private:
  static constexpr double r = 0.15, l = 0.39, g = 9.81;
  double mu_, transition_;
};

TEST(SlidingFriction, SliderCrankAgainstItsReducedEquation) {
  const double mu = 0.4, transition = 0.3;
  const Values friction = {{"vehicle_slider_crank_guide_friction", text(mu)},
                           {"vehicle_slider_crank_guide_transition_speed", text(transition)}};
  const RubbingCrank crank(mu, transition);
  Results smooth = run_scene("slider_crank");
  for (const bool implicit : {true, false}) {
    Results run = run_scene("slider_crank", implicit ? friction : friction + explicit_method);
    const std::vector<double> t = run.time();
    const auto motion = [&](const State<2>& at) { return State<2>(at[1], crank.acceleration(at[0], at[1])); };
    State<2> y(0.5 * std::numbers::pi, 0.0);
    const double start = y[0];
    double worst = 0.0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double angle = run("/vehicles/0/crank/position")[3 * i + 2] - run("/vehicles/0/crank/position")[2];
      worst = std::max(worst, std::abs(angle - (y[0] - start)));
      const int substeps = 20;
      const double h = 1e-3 / substeps;
      for (int k = 0; k < substeps; ++k) {
        runge_kutta<2>(motion, h, y);
      }
    }
    const double turned = smooth("/vehicles/0/crank/position").back() - start;
    RecordProperty(implicit ? "implicit_error" : "explicit_error", text(worst));
    RecordProperty("turns_with_and_without", text(y[0] / 6.283) + " " + text(turned / 6.283));
    EXPECT_LT(y[0] - start, 0.97 * turned) << "friction slows it";
    EXPECT_LT(worst, 1e-6 * (y[0] - start));
    EXPECT_LT(energy_error(run), 1e-6);
    expect_newton(run);
  }
}

// Two bodies and a third that slide on each other in free fall: friction keeps momentum and angular momentum.
constexpr const char* falling = R"(
vehicle:
  toy:
    bodies: [base, sled, arm]
    joints: [rail, track]
    springs: [pull]
    base: {mass: 3.0, inertia: 0.8, position: [0.0, 0.0], velocity: [0.2, -0.1, 0.7]}
    sled: {mass: 1.0, inertia: 0.1, position: [0.6, 0.4]}
    arm:  {mass: 0.7, inertia: 0.2, position: [-0.5, 0.9], velocity: [1.0, 0.3, -2.0]}
    rail:  {type: prismatic, bodies: [base, sled], point: [0.5, 0.3], axis: [1.0, 0.2], friction: 0.3, friction_force: 0.4, transition_speed: 0.1}
    track: {type: slot, bodies: [base, arm], point: [-0.3, 0.6], axis: [0.1, 1.0], friction: 0.5, transition_speed: 0.1}
    pull: {bodies: [sled, arm], from: [0.7, 0.4], to: [-0.6, 1.2], stiffness: 25.0, free_length: 0.9}
scene: {start: given}
gravity: 0.0
ts: {max_time: 1.5, dt: 1.0e-3}
output: {interval: 0.01}
)";

TEST(SlidingFriction, KeepsMomentumAndTakesTheEnergyItSays) {
  const std::vector<std::string> names = {"base", "sled", "arm"};
  const std::vector<std::pair<double, double>> bodies = {{3.0, 0.8}, {1.0, 0.1}, {0.7, 0.2}};
  for (const Values& options : {Values{}, explicit_method}) {
    Results run = run_yaml(falling, options);
    Vector2d first(0.0, 0.0);
    double first_spin = 0.0, worst = 0.0, worst_spin = 0.0;
    for (std::size_t i = 0; i < run.time().size(); ++i) {
      Vector2d momentum(0.0, 0.0);
      double spin = 0.0;
      for (std::size_t b = 0; b < names.size(); ++b) {
        const double* q = &run("/vehicles/0/" + names[b] + "/position")[3 * i];
        const double* v = &run("/vehicles/0/" + names[b] + "/velocity")[3 * i];
        momentum += bodies[b].first * Vector2d(v[0], v[1]);
        spin += bodies[b].first * (q[0] * v[1] - q[1] * v[0]) + bodies[b].second * v[2];
      }
      if (i == 0) first = momentum;
      if (i == 0) first_spin = spin;
      worst = std::max(worst, (momentum - first).norm());
      worst_spin = std::max(worst_spin, std::abs(spin - first_spin));
    }
    RecordProperty("momentum", text(worst));
    RecordProperty("angular_momentum", text(worst_spin));
    EXPECT_LT(worst, 1e-8 * 3.0);
    EXPECT_LT(worst_spin, 1e-7 * 2.0);
    EXPECT_GT(run("/energy/dissipated").back(), 0.3);
    EXPECT_LT(energy_error(run), 1e-6);
    expect_newton(run);
  }
}

TEST(SlidingFriction, ImplicitAndExplicitMethodsAgree) {
  Results implicit = run_yaml(falling, {{"ts_dt", "5e-4"}}), explicitly = run_yaml(falling, explicit_method);
  for (const char* name : {"/vehicles/0/sled/position", "/vehicles/0/arm/velocity", "/vehicles/0/rail/reaction"}) {
    const double error = relative_difference(implicit(name), explicitly(name));
    RecordProperty(name, text(error));
    EXPECT_LT(error, 1e-5) << name;
  }
}

// A mass on a spring that friction stops where it is: below F/k from rest it stays, which a large step must manage.
TEST(SlidingFriction, HoldsWhatItStops) {
  Results run = run_yaml(R"(
vehicle:
  block:
    bodies: [block]
    joints: [slide]
    springs: [spring]
    block: {mass: 2.0, inertia: 1.0, position: [0.3, 0.0]}
    slide: {type: prismatic, bodies: [ground, block], point: [0.3, 0.0], axis: [1.0, 0.0], friction: 0.5, transition_speed: 1.0e-4}
    spring: {bodies: [ground, block], from: [-1.0, 0.0], to: [0.3, 0.0], stiffness: 150.0, free_length: 1.0}
scene: {start: given}
ts: {max_time: 3.0, dt: 5.0e-3}
output: {interval: 0.01}
)");
  // F/k = 0.5*2*9.81/150: two turns of 2 F/k each leave less than F/k
  const double hold = 9.81 / 150.0, left = 0.3 - 4.0 * hold;
  ASSERT_LT(std::abs(left), hold);
  EXPECT_NEAR(run("/vehicles/0/block/position").end()[-3], left, 0.02 * 0.3);
  EXPECT_LT(std::abs(run("/vehicles/0/block/velocity").end()[-3]), 1e-4);
  EXPECT_NEAR(run("/vehicles/0/slide/reaction").end()[-3], 150.0 * left, 0.02 * 150.0 * 0.3)
      << "it takes the spring's force";
  EXPECT_NEAR(run("/vehicles/0/slide/reaction").end()[-2], 2.0 * 9.81, 1e-9);
}

TEST(SlidingFriction, RefusesJointsThatDoNotSlide) {
  const auto run = [](const char* option, const char* value) {
    return message_of([&] { run_scene("slider_crank", {{option, value}}); });
  };
  EXPECT_TRUE(contains(run("vehicle_slider_crank_bearing_friction", "0.3"), "prismatic or slot"));
  EXPECT_TRUE(contains(run("vehicle_slider_crank_guide_transition_speed", "0.3"), "needs friction"));
  EXPECT_TRUE(contains(run("vehicle_slider_crank_guide_friction", "-0.1"), "guide_friction"));
}

// A light shoe under a heavy block, a steep strut between: mu tan(slope) is 0.95, then 1.25.
constexpr const char* strut = R"(
vehicle:
  strut:
    bodies: [shoe, block]
    joints: [floor, wall, rod]
    shoe: {mass: 0.01, inertia: 0.1, position: [0.0, 0.0], velocity: [-1.0, 0.0, 0.0]}
    block: {mass: 50.0, inertia: 0.1, position: [0.2, 1.0], velocity: [0.0, -0.2, 0.0]}
    floor: {type: prismatic, bodies: [ground, shoe], point: [0.0, 0.0], axis: [1.0, 0.0], friction: 0.19, transition_speed: 1.0e-3}
    wall: {type: prismatic, bodies: [ground, block], point: [0.2, 1.0], axis: [0.0, 1.0]}
    rod: {type: distance, bodies: [shoe, block], from: [0.0, 0.0], to: [0.2, 1.0]}
scene: {start: given}
ts: {max_time: 0.05, dt: 1.0e-3}
output: {interval: 0.01}
)";

TEST(SlidingFriction, ThatJamsEndsTheRunInWords) {
  Results run = run_yaml(strut);
  EXPECT_LT(energy_error(run), 1e-9);
  for (const char* method : {"arkimex", "rk"}) {
    try {
      run_yaml(strut, {{"vehicle_strut_floor_friction", "0.25"}, {"ts_type", method}});
      ADD_FAILURE() << "it does not jam";
    } catch (const SolverError& error) {
      EXPECT_TRUE(contains(error.what(), "friction jams joint 'floor'")) << error.what();
    }
  }
}

// The guides slip on the bump and hold again: the bounce dies out with the last of them, whatever the springs are.
TEST(SlidingFriction, AFreightWagonComesToRestInItsGuides) {
  Results run = run_scene("freight_wagon");
  for (const char* guide : {"guide_1", "guide_2", "guide_3", "guide_4"}) {
    const std::vector<double> along = run.column(std::string("/vehicles/0/") + guide + "/reaction", 1);
    EXPECT_NEAR(std::abs(peak(along).first), 9.0e3, 30.0) << "slips, the guide being turned by less than 1e-3";
    EXPECT_LT(std::abs(along.back()), 2.0e3) << "holds";
  }
  EXPECT_LT(energy_error(run), 1e-5);
  EXPECT_GT(run("/energy/dissipated").back(), 100.0);
}

}  // namespace
}  // namespace traverse::test
