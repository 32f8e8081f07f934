// Long chains of bodies, whose equations are solved in their sparse form: a hanging chain against an own integration,
// the chain of an escalator against the closed form of a polygon drive, and the same motion by another formulation.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/curve.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

constexpr int links = 40;
constexpr double mass = 2.0, length = 0.3, gravity = 9.81;  // kg, m, m/s2 of a rod

/// Rods hinged to one another and to the ground, whose angles from the vertical and rates are x.
Eigen::VectorXd rates_of_rods(const Eigen::VectorXd& x) {
  Eigen::MatrixXd M(links, links);
  Eigen::VectorXd force(links);
  for (int i = 0; i < links; ++i) {
    double sum = 0.0;
    for (int j = 0; j < links; ++j) {
      const double below = links - 1 - std::max(i, j);  // rods that hang on both
      const double inertia = i == j ? below + 1.0 / 3.0 : below + 0.5;
      M(i, j) = mass * length * length * inertia * std::cos(x[i] - x[j]);
      sum += mass * length * length * inertia * std::sin(x[i] - x[j]) * x[links + j] * x[links + j];
    }
    force[i] = -sum - mass * gravity * length * (links - 1 - i + 0.5) * std::sin(x[i]);
  }
  Eigen::VectorXd rate(2 * links);
  rate << x.tail(links), M.ldlt().solve(force);
  return rate;
}

/// The chain's end after `time`, from a straight line at 0.6 rad; by the classical method of Runge and Kutta.
Eigen::Vector2d end_of_rods(double time, int steps) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2 * links);
  x.head(links).setConstant(0.6);
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const Eigen::VectorXd a = rates_of_rods(x), b = rates_of_rods(x + 0.5 * h * a), c = rates_of_rods(x + 0.5 * h * b),
                          d = rates_of_rods(x + h * c);
    x += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  Eigen::Vector2d end = Eigen::Vector2d::Zero();
  for (int i = 0; i < links; ++i) end += length * Eigen::Vector2d(std::sin(x[i]), -std::cos(x[i]));
  return end;
}

TEST(Chains, HangingChain) {
  const double s = std::sin(0.6), c = std::cos(0.6);
  const std::string pitch = text(length * s) + ", " + text(-length * c);
  Results run = run_yaml(
      "scene: {start: given}\nvehicle:\n  chain:\n    bodies: [rod]\n    joints: [top, pin]\n    sensors: [end]\n"
      "    repeat: {parts: [rod, pin], count: 40, pitch: [" +
      pitch + "]}\n    rod: {mass: 2.0, inertia: 0.015, angle: 0.6, position: [" + text(0.5 * length * s) + ", " +
      text(-0.5 * length * c) + "]}\n    top: {type: revolute, bodies: [ground, rod0], point: [0, 0]}\n" +
      "    pin: {type: revolute, bodies: [rod, rod+1], point: [" + pitch + "]}\n    end: {body: rod39}\n" +
      "ts: {type: esdirk4, dt: 2.0e-3, max_time: 1.5}\noutput: {interval: 1.5}\n");
  const std::vector<double> place = run("/vehicles/0/rod39/position");  // of the centre of mass of the last rod
  const double angle = place[5];
  const Eigen::Vector2d end(place[3] + 0.5 * length * std::sin(angle), place[4] - 0.5 * length * std::cos(angle));
  const Eigen::Vector2d exact = end_of_rods(1.5, 3000);
  EXPECT_LT((end_of_rods(1.5, 1500) - exact).norm(), 1e-7);  // the integration is exact enough
  RecordProperty("error", text((end - exact).norm()));
  EXPECT_LT((end - exact).norm(), 2e-6);
  EXPECT_LT(energy_error(run), 1e-8);
}

/// The chain of options/scenes/escalator_chain.yml, with the mass of the steps at the height of their axles, so that
/// the jerks do not turn the steps.
Results escalator_chain(const std::string& count) {
  return run_scene("escalator_chain",
                   {{"vehicle_stairs_step_position", "-0.15,0.05"}, {"vehicle_stairs_repeat_count", count}});
}

// Each link pulls the steps behind it: T = M (g sin(a) + dv/dt), with the slope of v between two rows of the table.
TEST(Chains, PolygonDrive) {
  Results run = escalator_chain("20");
  constexpr double teeth = 16.0, pitch = 0.4 / 3.0, speed = 0.5, period = pitch / speed, piece = period / 8.0;
  const double omega = 2.0 * std::numbers::pi / (teeth * period);
  const double radius = 0.5 * pitch / std::sin(std::numbers::pi / teeth);
  const auto v = [&](double t) { return omega * radius * std::cos(omega * t - std::numbers::pi / teeth); };
  const double along = gravity * 0.57735 / std::hypot(1.0, 0.57735);
  const std::vector<double> time = run.time();
  int jerks = 0;
  double error = 0.0;
  for (const int link : {0, 7, 18}) {
    const std::vector<double> reaction = run("/vehicles/0/link" + std::to_string(link) + "/reaction");
    const double behind = 24.0 * (19 - link);
    for (std::size_t i = 1; i < time.size(); ++i) {
      const double within = std::fmod(time[i], period);
      const double start = piece * std::floor(within / piece);
      if (within - start < 1e-6 || start + piece - within < 1e-6) continue;  // the acceleration jumps here
      const double acceleration = (v(start + piece) - v(start)) / piece;
      error = std::max(error, std::abs(reaction[3 * i] / (behind * (along + acceleration)) - 1.0));
      if (acceleration < -0.1) ++jerks;
    }
  }
  EXPECT_GT(jerks, 10);
  RecordProperty("error", text(error));
  EXPECT_LT(error, 1e-5);
  EXPECT_LT(energy_error(run), 1e-6);
}

/// A step of options/vehicles/escalator_steps.yml on its two rollers, whose axles the chain moves along the track: the
/// height y of the front axle and the pitch phi, each part at (dx, dy) from that axle.
class PitchingStep {
 public:
  PitchingStep(double along, double across) : along_(along), across_(across) {
    for (const Part& p : parts) {
      const Eigen::Vector2d x(0.0, -p.dy), y(1.0, p.dx);
      M_ += p.mass * (x * x.transpose() + y * y.transpose());
      M_(1, 1) += p.inertia;
    }
    for (const double dx : {0.0, -0.3}) K_ += 1.0e6 * Eigen::Vector2d(1.0, dx) * Eigen::RowVector2d(1.0, dx);
    s_.head<2>() = K_.inverse() * load(0.0);
  }
  /// phi'' while the axles accelerate by a, m/s2.
  double pitch_acceleration(double a) const { return rate(s_, a)[3]; }
  /// Runge and Kutta.
  void advance(double a, double h) {
    const Eigen::Vector4d k1 = rate(s_, a), k2 = rate(s_ + 0.5 * h * k1, a), k3 = rate(s_ + 0.5 * h * k2, a),
                          k4 = rate(s_ + h * k3, a);
    s_ += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }

 private:
  struct Part {
    double dx, dy, mass, inertia;
  };
  static constexpr Part parts[] = {{0.0, 0.0, 7.0, 0.01}, {-0.15, 0.1, 16.0, 0.5}, {-0.3, 0.0, 1.0, 0.01}};

  Eigen::Vector2d load(double a) const {
    Eigen::Vector2d forces = Eigen::Vector2d::Zero();
    for (const Part& p : parts)
      forces -= p.mass * (across_ * Eigen::Vector2d(1.0, p.dx) + (along_ + a) * Eigen::Vector2d(0.0, -p.dy));
    return forces;
  }
  Eigen::Vector4d rate(const Eigen::Vector4d& s, double a) const {
    Eigen::Vector4d r;
    r << s.tail<2>(), M_.inverse() * (load(a) - K_ * (s.head<2>() + 5.0e-4 * s.tail<2>()));
    return r;
  }

  double along_, across_;  // gravity along and across the track, m/s2
  Eigen::Matrix2d M_ = Eigen::Matrix2d::Zero(), K_ = Eigen::Matrix2d::Zero();
  Eigen::Vector4d s_ = Eigen::Vector4d::Zero();
};

// The steps of the scene pitch after each jerk: T = M (g sin(a) + dv/dt) - m h phi'' for each step behind.
TEST(Chains, StepsPitch) {
  Results run = run_scene("escalator_chain", {{"ts_max_time", "0.4"}});
  constexpr double teeth = 16.0, pitch = 0.4 / 3.0, speed = 0.5, period = pitch / speed, piece = period / 8.0;
  constexpr int substeps = 2000;  // of a piece of the table
  const double omega = 2.0 * std::numbers::pi / (teeth * period);
  const double radius = 0.5 * pitch / std::sin(std::numbers::pi / teeth), steep = std::hypot(1.0, 0.57735);
  const auto v = [&](double t) { return omega * radius * std::cos(omega * t - std::numbers::pi / teeth); };
  PitchingStep step(gravity * 0.57735 / steep, gravity / steep);
  const std::vector<double> time = run.time();
  double error = 0.0, by_pitch = 0.0;
  std::size_t sample = 1;
  for (int k = 0; sample < time.size(); ++k) {
    const double start = piece * (k % 8), a = (v(start + piece) - v(start)) / piece, h = piece / substeps;
    for (int i = 0; i < substeps && sample < time.size(); ++i) {
      const double t = piece * k + h * i;
      if (time[sample] < t + 0.5 * h) {
        const double pull = -16.0 * 0.1 * step.pitch_acceleration(a);
        for (const int link : {0, 7, 18}) {
          const std::vector<double>& reaction = run("/vehicles/0/link" + std::to_string(link) + "/reaction");
          const double weight = 24.0 * gravity * 0.57735 / steep, behind = 19 - link;
          const bool jumps = i < 2 || i > substeps - 2;
          if (!jumps)
            error = std::max(error, std::abs(reaction[3 * sample] / behind - weight - 24.0 * a - pull) / weight);
        }
        by_pitch = std::max(by_pitch, std::abs(pull) * 19.0);
        ++sample;
      }
      step.advance(a, h);
    }
  }
  EXPECT_GT(by_pitch, 5.0);
  RecordProperty("error", text(error));
  EXPECT_LT(error, 2e-5);
}

// Twenty steps are few enough for the projected matrices, thirty are not: the rear of both chains moves alike.
TEST(Chains, SparseAndProjectedEquationsAgree) {
  Results few = escalator_chain("8"), many = escalator_chain("40");
  const std::vector<double> one = few("/vehicles/0/link2/reaction"), other = many("/vehicles/0/link34/reaction");
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); i += 3) EXPECT_NEAR(one[i], other[i], 1e-6 * std::abs(one[0]));
}

}  // namespace
}  // namespace traverse::test
