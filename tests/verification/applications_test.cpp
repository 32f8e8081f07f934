// The applications that the paper names beside trains, against integrations of the same problems: a launcher, an
// overhead crane and the stage of a precision machine.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/scene_run.hpp"
#include "traverse/base/time_function.hpp"

namespace traverse::test {
namespace {

constexpr double gravity = 9.81;
using Coordinates = Eigen::VectorXd;

/// One step of the classical method of Runge and Kutta.
Coordinates stepped(const std::function<Coordinates(double, const Coordinates&)>& rate, double t, const Coordinates& x,
                    double h) {
  const Coordinates a = rate(t, x), b = rate(t + 0.5 * h, x + 0.5 * h * a), c = rate(t + 0.5 * h, x + 0.5 * h * b),
                    d = rate(t + h, x + h * c);
  return x + h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
}

base::TimeFunction table(const std::string& name) {
  std::vector<double> times, values;
  for (const std::vector<double>& row : read_table(source_folder() + "/options/scenes/" + name)) {
    times.push_back(row[0]);
    values.push_back(row[1]);
  }
  return {times, values};
}

/// The missile of options/scenes/launcher.yml on the modes of a clamped-free beam.
class Launcher {
 public:
  static constexpr int modes = 16, x = 2 * (modes + 2);  // state: coordinates, their rates, x and its rate
  static constexpr double length = 4.0, EI = 2.0e5, mass = 15.0, missile = 100.0, arm = 0.6, stiffness = 5.0e6,
                          damping = 2.0e3, inertia = 60.0 + 2.0 * (1.0e-3 + arm * arm);
  const double across = gravity / std::sqrt(2.0);

  Launcher() {
    for (int n = 0; n < modes; ++n) {  // cos(b) cosh(b) = -1
      double low = 3.14159265358979 * n, high = low + 3.14159265358979;
      for (int i = 0; i < 100; ++i) {
        const double b = 0.5 * (low + high), f = std::cos(b) + 1.0 / std::cosh(b);
        ((n % 2 == 0) == (f > 0.0) ? low : high) = b;
      }
      root_[n] = low;
      omega2_[n] = EI / mass * std::pow(low / length, 4);
    }
  }

  // cosh(s) - cos(s) - r (sinh(s) - sin(s)) with r = (cosh(b) + cos(b))/(sinh(b) + sin(b)); 1 - r is tiny for high
  // modes.
  static double deficit(double b) { return (std::sin(b) - std::cos(b) - std::exp(-b)) / (std::sinh(b) + std::sin(b)); }
  double shape(int n, double at) const {
    const double b = root_[n], s = b * at / length, d = deficit(b);
    return std::exp(-s) + d * std::sinh(s) - std::cos(s) + (1.0 - d) * std::sin(s);
  }
  double shape_slope(int n, double at) const {
    const double b = root_[n], s = b * at / length, d = deficit(b);
    return b / length * (-std::exp(-s) + d * std::cosh(s) + std::sin(s) + (1.0 - d) * std::cos(s));
  }

  Coordinates rate(double t, const Coordinates& s) const {
    Coordinates r = Coordinates::Zero(x + 2);
    r.head(modes + 2) = s.segment(modes + 2, modes + 2);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(modes + 2);  // on modes, y and angle
    force[modes] = -missile * across;
    double along = 0.0;
    for (const double side : {arm, -arm}) {
      const double at = s[x] + side;
      if (at > length) continue;
      double rail = 0.0, rail_rate = 0.0, slope = 0.0;
      for (int n = 0; n < modes; ++n) {
        rail += s[n] * shape(n, at);
        slope += s[n] * shape_slope(n, at);
        rail_rate += s[modes + 2 + n] * shape(n, at) + s[n] * shape_slope(n, at) * s[x + 1];
      }
      const double F = -stiffness * (s[modes] + side * s[modes + 1] - rail) -
                       damping * (s[2 * modes + 2] + side * s[2 * modes + 3] - rail_rate);
      force[modes] += F;
      force[modes + 1] += side * F;
      along -= slope * F;
      for (int n = 0; n < modes; ++n) force[n] -= F * shape(n, at);
    }
    for (int n = 0; n < modes; ++n) r[modes + 2 + n] = force[n] / (mass * length) - omega2_[n] * s[n];
    r[2 * modes + 2] = force[modes] / missile;
    r[2 * modes + 3] = force[modes + 1] / inertia;
    r[x] = s[x + 1];
    r[x + 1] = std::min(t / 0.05, 1.0) * 11000.0 / missile - across + along / missile;
    return r;
  }

  /// The static equilibrium at x = 1 m under a force that holds the missile.
  Coordinates at_rest() const {
    Coordinates s = Coordinates::Zero(x + 2);
    s[x] = 1.0;
    Eigen::MatrixXd K(modes + 2, modes + 2);
    const auto forces = [&](const Coordinates& at) {
      Eigen::VectorXd f = rate(0.0, at).segment(modes + 2, modes + 2);
      return f;
    };
    const Eigen::VectorXd zero = forces(s);
    for (int i = 0; i < modes + 2; ++i) {
      Coordinates moved = s;
      moved[i] = 1.0e-3;
      K.col(i) = (forces(moved) - zero) / 1.0e-3;
    }
    s.head(modes + 2) = -K.partialPivLu().solve(zero);
    return s;
  }

  /// The state when the rear shoe is at the tip, and the time.
  std::pair<double, Coordinates> exit(double h) const {
    Coordinates s = at_rest();
    double t = 0.0;
    const auto f = [this](double time, const Coordinates& y) { return rate(time, y); };
    for (const double event : {length - arm, length + arm}) {  // a step ends where a shoe leaves the rail
      while (true) {
        const Coordinates next = stepped(f, t, s, h);
        if (next[x] < event) {
          s = next;
          t += h;
          continue;
        }
        double low = 0.0, high = h;
        for (int i = 0; i < 60; ++i) {
          const double middle = 0.5 * (low + high);
          (stepped(f, t, s, middle)[x] < event ? low : high) = middle;
        }
        s = stepped(f, t, s, high);
        t += high;
        break;
      }
    }
    return {t, s};
  }

 private:
  std::array<double, modes> root_{}, omega2_{};
};

TEST(Applications, Launcher) {
  Results run = run_scene("launcher");
  const Launcher launcher;
  const auto [time, s] = launcher.exit(1e-5);
  double tip = 0.0, tip_rate = 0.0;
  for (int n = 0; n < Launcher::modes; ++n) {
    tip += s[n] * launcher.shape(n, 4.0);
    tip_rate += s[Launcher::modes + 2 + n] * launcher.shape(n, 4.0);
  }
  const std::vector<double> position = run("/exit/position"), velocity = run("/exit/velocity");
  EXPECT_NEAR(run("/exit/time")[0], time, 1e-5);
  EXPECT_NEAR(velocity[0], s[Launcher::x + 1], 1e-3);
  EXPECT_NEAR(position[1] - 0.05, s[Launcher::modes], 1e-3 * std::abs(tip));
  EXPECT_NEAR(position[2], s[Launcher::modes + 1], 1e-3 * std::abs(s[Launcher::modes + 1]));
  EXPECT_NEAR(velocity[1], s[2 * Launcher::modes + 2], 1e-3);
  const double tip_error = std::abs(run("/exit/tip_deflection")[0] / tip - 1.0),
               turn_error = std::abs(velocity[2] / s[2 * Launcher::modes + 3] - 1.0);
  RecordProperty("tip_error", text(tip_error));
  RecordProperty("turn_error", text(turn_error));
  EXPECT_LT(tip_error, 1e-3);
  EXPECT_LT(turn_error, 1e-3);
  // The tip is released when the rear shoe leaves: its velocity before that does not depend on the step.
  Results half = run_scene("launcher", {{"ts_dt", "5e-5"}, {"ts_max_time", "0.3"}});
  EXPECT_NEAR(run("/exit/tip_velocity")[0], half("/exit/tip_velocity")[0], 1e-4);
  // The velocity of the tip contains high modes; it needs short elements and steps.
  Results fine = run_scene("launcher", {{"ts_dt", "1e-5"}, {"ts_max_time", "0.3"}, {"beam_elements_per_span", "64"}});
  EXPECT_NEAR(fine("/exit/tip_velocity")[0], tip_rate, 1e-3);
  EXPECT_LT(energy_error(run), 1e-6);
}

// A load on two parallel falls does not turn; the trolley runs on a rigid girder.
TEST(Applications, OverheadCrane) {
  Results run = run_scene("overhead_crane", {{"beam_EI", "1e14"}, {"ts_dt", "2e-3"}, {"beam_elements_per_span", "4"}});
  const base::TimeFunction hoist = table("overhead_crane_hoist.csv");
  const std::vector<std::vector<double>> law = read_table(source_folder() + "/options/scenes/overhead_crane_speed.csv");
  const auto trolley = [&](double t) {  // position and speed
    double x = 0.0, v = 0.0;
    for (std::size_t i = 0; i + 1 < law.size(); ++i) {
      const double h = std::clamp(t - law[i][0], 0.0, law[i + 1][0] - law[i][0]);
      const double a = (law[i + 1][1] - law[i][1]) / (law[i + 1][0] - law[i][0]);
      if (h > 0.0) v = law[i][1] + a * h;
      x += law[i][1] * h + 0.5 * a * h * h;
    }
    return std::pair(x, v);
  };
  constexpr double load = 1.0e4, stiffness = 3.5e6, damping = 7.5e3, free_length = 7.972;  // both falls
  double tension = 0.0;
  const auto rate = [&](double t, const Coordinates& s) {
    const auto [x, v] = trolley(t);
    const Eigen::Vector2d d(s[0] - x, s[1]), relative(s[2] - v, s[3]);
    const double l = d.norm();
    tension =
        std::max(0.0, stiffness * (l - free_length - hoist.value(t)) + damping * (d.dot(relative) / l - hoist.rate(t)));
    Coordinates r(4);
    r << s[2], s[3], -tension * d.x() / l / load, -tension * d.y() / l / load - gravity;
    return r;
  };
  Coordinates s(4);
  s << 0.0, -(free_length + load * gravity / stiffness), 0.0, 0.0;
  const std::vector<double> time = run.time(), hook = run("/vehicles/0/load/position"),
                            carriage = run("/vehicles/0/trolley/position"), front = run("/vehicles/0/front_fall/force"),
                            rear = run("/vehicles/0/rear_fall/force");
  double greatest = 0.0, later = 0.0, sway_error = 0.0;
  const double h = 1.0e-3;
  long steps = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    for (; static_cast<double>(steps) * h < time[i] - 1e-9; ++steps)
      s = stepped(rate, static_cast<double>(steps) * h, s, h);
    (void)rate(time[i], s);
    const double sway = hook[3 * i] - carriage[3 * i];
    sway_error = std::max(sway_error, std::abs(sway - (s[0] - trolley(time[i]).first)));
    EXPECT_NEAR(front[i] + rear[i], tension, 1e-3 * load * gravity) << time[i];
    greatest = std::max(greatest, std::abs(sway));
    if (time[i] > 19.9) later = std::max(later, std::abs(sway));
  }
  EXPECT_NEAR(greatest, 0.2988, 2e-3);  // 2 a l/g
  EXPECT_LT(later, 1e-3);
  RecordProperty("sway_error", text(sway_error));
  EXPECT_LT(sway_error, 2e-4);
  EXPECT_NEAR(hook[1] + 2.0, hook[hook.size() - 2], 1e-3);
  EXPECT_LT(energy_error(run), 1e-6);
}

TEST(Applications, PrecisionStage) {
  Results run = run_scene("precision_stage");
  const base::TimeFunction motion = table("precision_stage_motion.csv");
  const auto rate = [&](double t, const Coordinates& s) {
    Coordinates r(2);
    r << s[1], (-1.0e7 * (s[0] - motion.value(t)) - 8.0e3 * (s[1] - motion.rate(t))) / 30.0;
    return r;
  };
  Coordinates s = Coordinates::Zero(2);
  const std::vector<double> time = run.time(), carriage = run("/vehicles/0/carriage/position");
  double greatest = 0.0, settled = 0.0, worst = 0.0;
  long steps = 0;
  const double h = 1.0e-5;
  for (std::size_t i = 0; i < time.size(); ++i) {
    for (; static_cast<double>(steps) * h < time[i] - 1e-9; ++steps)
      s = stepped(rate, static_cast<double>(steps) * h, s, h);
    const double error = carriage[3 * i] - carriage[0] - motion.value(time[i]);
    worst = std::max(worst, std::abs(error - (s[0] - motion.value(time[i]))));
    greatest = std::max(greatest, std::abs(error));
    if (std::abs(error) > 1e-6) settled = time[i];
  }
  EXPECT_NEAR(greatest, 4.754e-5, 1e-7);
  RecordProperty("worst", text(worst));
  EXPECT_LT(worst, 5e-8);
  EXPECT_NEAR(settled, 0.619, 2e-3);
  EXPECT_LT(energy_error(run), 1e-6);
}

}  // namespace
}  // namespace traverse::test
