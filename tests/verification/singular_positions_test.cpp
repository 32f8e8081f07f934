// Mechanisms that run through positions where their constraints lose rank, or that cannot go on: linkages whose bars
// all come to lie on one line, change points, lock-up.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/four_bars.hpp"
#include "support/message.hpp"
#include "support/program.hpp"

namespace traverse::test {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr double gravity = 9.81;

double energy_drift(Results& run) { return std::abs(peak(run("/energy/residual")).first); }

// --- N four-bars -----------------------------------------------------------------------------------------------------

/// Angle of a crank: theta'' = -G cos(theta)/I, of all rods together, at the multiples of `interval`.
std::vector<double> crank_angles(int n, double interval, std::size_t count) {
  const double bars = n + 1.0, inertia = bars / 3.0 + n, weight = gravity * (0.5 * bars + n);
  const auto rate = [&](const Vector2d& s) { return Vector2d(s[1], -weight / inertia * std::cos(s[0])); };
  const int substeps = 400;
  const double h = interval / substeps;
  Vector2d y(0.5 * pi, -1.0);
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(y[0]);
    for (int k = 0; k < substeps; ++k) {
      const Vector2d a = rate(y), b = rate(y + 0.5 * h * a), c = rate(y + 0.5 * h * b), d = rate(y + h * c);
      y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
  }
  return out;
}

/// A point of a body, half a metre from its centre along its angle (or against it).
Vector2d end_of(Results& run, const std::string& body, std::size_t row, double half) {
  const double* q = &run("/vehicles/0/" + body + "/position")[3 * row];
  return {q[0] + half * std::cos(q[2]), q[1] + half * std::sin(q[2])};
}

/// The farthest that the two sides of a pin are apart.
double worst_pin(Results& run, int n) {
  double worst = 0.0;
  for (std::size_t row = 0; row < run.time().size(); ++row) {
    for (int i = 0; i <= n; ++i)
      worst = std::max(worst, (end_of(run, "crank" + std::to_string(i), row, -0.5) - Vector2d(i, 0.0)).norm());
    for (int i = 0; i < n; ++i)
      for (int side = 0; side < 2; ++side)
        worst = std::max(worst, (end_of(run, "crank" + std::to_string(i + side), row, 0.5) -
                                 end_of(run, "coupler" + std::to_string(i), row, side - 0.5))
                                    .norm());
  }
  return worst;
}

struct BarsCase {
  int n;
  const char *step, *type;
};
class FourBars : public testing::TestWithParam<BarsCase> {};
INSTANTIATE_TEST_SUITE_P(SingularPositions, FourBars,
                         testing::Values(BarsCase{2, "1e-2", "arkimex"}, BarsCase{2, "1e-2", "rk"},
                                         BarsCase{2, "1e-3", "arkimex"}, BarsCase{2, "1e-3", "rk"},
                                         BarsCase{2, "2.5e-4", "rk"}, BarsCase{10, "1e-2", "arkimex"},
                                         BarsCase{10, "1e-2", "rk"}, BarsCase{40, "1e-2", "arkimex"},
                                         BarsCase{40, "1e-2", "rk"}));

std::string bars_scene(int n) {
  std::string vehicle = four_bars(n), out = "vehicle:\n  bars:\n    ";
  for (const char c : vehicle) out += c == '\n' ? "\n    " : std::string(1, c);
  return out + "\nscene: {start: given}\nts: {max_time: 10.0}\noutput: {interval: 0.05}\n";
}

TEST_P(FourBars, RunThroughTheirSingularPositions) {
  const auto [n, step, type] = GetParam();
  const Values explicit_type = {{"ts_rk_type", "5dp"}};
  const Values options =
      Values{{"ts_dt", step}, {"ts_type", type}} + (type == std::string("rk") ? explicit_type : Values{});
  Results run = n == 40 ? run_scene("forty_four_bars", options) : run_yaml(bars_scene(n), options);
  const std::vector<double> theta = crank_angles(n, 0.05, run.time().size());
  ASSERT_EQ(run.time().size(), 201u);
  double worst = 0.0;
  for (std::size_t i = 0; i < theta.size(); ++i)
    worst = std::max(worst, (end_of(run, "crank0", i, 0.5) - Vector2d(std::cos(theta[i]), std::sin(theta[i]))).norm());
  RecordProperty("error", text(worst));
  RecordProperty("energy_drift", text(energy_drift(run)));
  RecordProperty("pins", text(worst_pin(run, n)));
  RecordProperty("wall_seconds", text(run.attribute("/", "wall_seconds")));
  EXPECT_LT(theta.back(), 0.5 * pi - 8.0 * pi) << "over four turns";
  EXPECT_LT(worst, 2e-6);
  EXPECT_LT(energy_drift(run), n == 40 ? 1e-4 : 1e-5);  // the benchmark accepts 0.1 J
  EXPECT_LT(worst_pin(run, n), 1e-12 * n);
}

// --- one parallelogram at its flat position --------------------------------------------------------------------------

/// Cranks of 1 m, pivots 2 m apart, the coupler's centre between them; a spring with a damper pulls crank 0 to flat.
std::string parallelogram(double angle, double rate, const std::string& spring) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto at = [](double x, double y) { return "[" + text(x) + ", " + text(y) + "]"; };
  const auto crank = [&](double x) {
    return "{mass: 1.0, inertia: 0.1, position: " + at(x + 0.5 * c, 0.5 * s) + ", angle: " + text(angle) +
           ", velocity: [" + text(-0.5 * rate * s) + ", " + text(0.5 * rate * c) + ", " + text(rate) + "]}\n";
  };
  return "vehicle:\n  bars:\n    bodies: [left, right, coupler]\n    joints: [a, b, c, d]\n" +
         std::string("    torsion_springs: [spring]\n    left: ") + crank(0.0) + "    right: " + crank(2.0) +
         "    coupler: {mass: 1.5, inertia: 0.5, position: " + at(1.0 + c, s) + ", velocity: [" + text(-rate * s) +
         ", " + text(rate * c) + ", 0.0]}\n" + "    a: {type: revolute, bodies: [ground, left], point: [0.0, 0.0]}\n" +
         "    b: {type: revolute, bodies: [left, coupler], point: " + at(c, s) + "}\n" +
         "    c: {type: revolute, bodies: [coupler, right], point: " + at(2.0 + c, s) + "}\n" +
         "    d: {type: revolute, bodies: [right, ground], point: [2.0, 0.0]}\n" +
         "    spring: {bodies: [ground, left], free_angle: 0.0, " + spring + "}\n" +
         "scene: {start: given}\ngravity: 0.0\nts: {max_time: 4.0, dt: 2.0e-3}\noutput: {interval: 0.02}\n";
}
constexpr double parallelogram_inertia = 2.0 * (0.1 + 0.25) + 1.5;  // about the pivots, kg m2

/// Its angle over time: theta'' + 2 z w theta' + w^2 theta = 0.
double swing(double t, double angle, double rate, double stiffness, double damping) {
  const double w = std::sqrt(stiffness / parallelogram_inertia), decay = 0.5 * damping / parallelogram_inertia;
  const double wd = std::sqrt(w * w - decay * decay);
  return std::exp(-decay * t) * (angle * std::cos(wd * t) + (rate + decay * angle) / wd * std::sin(wd * t));
}

double swing_error(Results& run, double angle, double rate, double stiffness, double damping) {
  double worst = 0.0;
  for (std::size_t i = 0; i < run.time().size(); ++i) {
    const double theta = swing(run.time()[i], angle, rate, stiffness, damping);
    for (const char* crank : {"left", "right"})
      worst = std::max(worst, std::abs(run(std::string("/vehicles/0/") + crank + "/position")[3 * i + 2] - theta));
    worst = std::max(worst, std::abs(run("/vehicles/0/coupler/position")[3 * i + 2]));
  }
  return worst;
}

TEST(Parallelogram, ComesToRestAtItsFlatPosition) {
  Results run = run_yaml(parallelogram(0.4, 0.0, "stiffness: 200.0, damping: 12.0"));
  const double error = swing_error(run, 0.4, 0.0, 200.0, 12.0);
  RecordProperty("error", text(error));
  EXPECT_LT(std::abs(swing(4.0, 0.4, 0.0, 200.0, 12.0)), 1e-4) << "singular all the time in the end";
  EXPECT_LT(error, 1e-6);
}

TEST(Parallelogram, StartsNearItsFlatPosition) {
  for (const double angle : {1e-3, 1e-6, -1e-4}) {
    Results run = run_yaml(parallelogram(angle, 3.0, "stiffness: 20.0"));
    const double error = swing_error(run, angle, 3.0, 20.0, 0.0);
    RecordProperty("error_from_" + text(angle), text(error));
    EXPECT_LT(error, 1e-5) << angle;
  }
}

// In it, the bars may go on as a parallelogram or crossed.
TEST(Parallelogram, AStartInTheFlatPositionIsRefused) {
  const std::string message = message_of([] { run_yaml(parallelogram(0.0, 3.0, "stiffness: 20.0")); });
  for (const char* part : {"vehicle 'bars'", "dead point", "start from another position"})
    EXPECT_TRUE(contains(message, part)) << message;
}

// --- a change point --------------------------------------------------------------------------------------------------

// Crank 1 m, pivots 3 m apart, coupler 2.5 m, rocker 1.5 m: 1 + 3 = 2.5 + 1.5, so that all lie on one line where the
// crank points away from the other pivot; there the linkage goes on from its open to its crossed assembly.
struct ChangePoint {
  static constexpr double coupler = 2.5, rocker = 1.5;
  Vector2d b, c;  // the crank's end, the pin of coupler and rocker
  explicit ChangePoint(double theta) {
    b = {std::cos(theta), std::sin(theta)};
    // (coupler + rocker)^2 - r^2 = 12 cos^2(theta/2): its root goes smoothly through zero
    const double square = 10.0 - 6.0 * std::cos(theta);
    const double along = (coupler * coupler - rocker * rocker + square) / (2.0 * square);
    const double across = std::cos(0.5 * theta) * std::sqrt(12.0 * (square - 1.0)) / (2.0 * square);
    const Vector2d line = Vector2d(3.0, 0.0) - b;
    c = b + along * line + across * Vector2d(-line.y(), line.x());
  }
  Vector2d coupler_centre() const { return 0.5 * (b + c); }
  Vector2d rocker_centre() const { return 0.5 * (c + Vector2d(3.0, 0.0)); }
};

/// Twice the kinetic energy over the square of the crank's rate: by central differences.
double inertia_at(double theta) {
  const double h = 1e-5;
  const ChangePoint low(theta - h), high(theta + h);
  const auto turned = [&](const Vector2d& from, const Vector2d& to) {
    return std::asin((from.x() * to.y() - from.y() * to.x()) / (from.norm() * to.norm())) / (2.0 * h);
  };
  const Vector2d D(3.0, 0.0);
  const double coupler = turned(low.c - low.b, high.c - high.b), rocker = turned(low.c - D, high.c - D);
  return 0.5 + 1.0 * 0.25 + 2.0 * ((high.coupler_centre() - low.coupler_centre()) / (2.0 * h)).squaredNorm() +
         1.0 * coupler * coupler + 1.5 * ((high.rocker_centre() - low.rocker_centre()) / (2.0 * h)).squaredNorm() +
         0.4 * rocker * rocker;
}

/// When the crank has turned from `from` to `to` by its kinetic energy alone: Simpson's rule on dt = d theta/rate.
double time_to_turn(double from, double to, double rate) {
  const int intervals = 2000;
  const double h = (to - from) / intervals, start = inertia_at(from);
  double sum = 0.0;
  for (int i = 0; i <= intervals; ++i)
    sum += (i == 0 || i == intervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * std::sqrt(inertia_at(from + i * h) / start);
  return sum * h / 3.0 / rate;
}

std::string change_point_scene(double theta, double rate) {
  const ChangePoint now(theta);
  const auto at = [](const Vector2d& p) { return "[" + text(p.x()) + ", " + text(p.y()) + "]"; };
  const double h = 1e-6;
  const ChangePoint low(theta - h), high(theta + h);
  const auto velocity = [&](const Vector2d& from, const Vector2d& to, const Vector2d& arm_from,
                            const Vector2d& arm_to) {
    const Vector2d v = rate * (to - from) / (2.0 * h);
    const double turned = std::asin((arm_from.x() * arm_to.y() - arm_from.y() * arm_to.x()) / arm_from.squaredNorm());
    return ", velocity: [" + text(v.x()) + ", " + text(v.y()) + ", " + text(rate * turned / (2.0 * h)) + "]}\n";
  };
  const Vector2d D(3.0, 0.0);
  return "vehicle:\n  bars:\n    bodies: [crank, coupler, rocker]\n    joints: [a, b, c, d]\n    crank: {mass: 1.0, " +
         std::string("inertia: 0.5, position: ") + at(0.5 * now.b) + ", angle: " + text(theta) +
         velocity(0.5 * low.b, 0.5 * high.b, low.b, high.b) +
         "    coupler: {mass: 2.0, inertia: 1.0, position: " + at(now.coupler_centre()) +
         velocity(low.coupler_centre(), high.coupler_centre(), low.c - low.b, high.c - high.b) +
         "    rocker: {mass: 1.5, inertia: 0.4, position: " + at(now.rocker_centre()) +
         velocity(low.rocker_centre(), high.rocker_centre(), low.c - D, high.c - D) +
         "    a: {type: revolute, bodies: [ground, crank], point: [0.0, 0.0]}\n" +
         "    b: {type: revolute, bodies: [crank, coupler], point: " + at(now.b) + "}\n" +
         "    c: {type: revolute, bodies: [coupler, rocker], point: " + at(now.c) + "}\n" +
         "    d: {type: revolute, bodies: [rocker, ground], point: [3.0, 0.0]}\n" +
         "scene: {start: given}\ngravity: 0.0\nts: {max_time: 6.0, dt: 2.0e-3}\noutput: {interval: 0.02}\n";
}

TEST(ChangePoint, GoesOnAlongItsSmoothBranch) {
  const double start = 1.0, rate = 3.0;
  for (const char* type : {"arkimex", "rk"}) {
    Results run = run_yaml(change_point_scene(start, rate), {{"ts_type", type}});
    double worst = 0.0, worst_time = 0.0, before = start, expected = 0.0;
    for (std::size_t i = 0; i < run.time().size(); ++i) {
      const double theta = run("/vehicles/0/crank/position")[3 * i + 2];
      const double* coupler = &run("/vehicles/0/coupler/position")[3 * i];
      const double* rocker = &run("/vehicles/0/rocker/position")[3 * i];
      const ChangePoint exact(theta);
      worst = std::max(worst, (exact.coupler_centre() - Vector2d(coupler[0], coupler[1])).norm());
      worst = std::max(worst, (exact.rocker_centre() - Vector2d(rocker[0], rocker[1])).norm());
      expected += time_to_turn(before, theta, rate * std::sqrt(inertia_at(start) / inertia_at(before)));
      worst_time = std::max(worst_time, std::abs(expected - run.time()[i]));
      before = theta;
    }
    RecordProperty(std::string(type) + "_turns", text((before - start) / (2.0 * pi)));
    RecordProperty(std::string(type) + "_position_error", text(worst));
    RecordProperty(std::string(type) + "_time_error", text(worst_time));
    RecordProperty(std::string(type) + "_energy", text(energy_drift(run)));
    EXPECT_GT(before - start, 2.0 * pi) << "through the change point";
    EXPECT_LT(worst, 1e-9);
    EXPECT_LT(worst_time, 1e-5);
    EXPECT_LT(energy_drift(run), 1e-5);
  }
}

// --- lock-up ---------------------------------------------------------------------------------------------------------

// A slider driven away from its crank's bearing at 0.5 m/s: crank and rod, 0.4 and 0.6 m, reach 1 m.
TEST(LockUp, ADriverBeyondTheReachStopsTheRun) {
  const Workplace workplace(R"(
vehicle:
  press:
    bodies:  [crank, rod, slider]
    joints:  [bearing, crank_pin, slider_pin, guide]
    drivers: [ram]
    crank:  {mass: 2.0, inertia: 0.02, position: [0.0, 0.2]}
    rod:    {mass: 1.0, inertia: 0.015, position: [0.22360679774997896, 0.2]}
    slider: {mass: 1.5, inertia: 0.002, position: [0.4472135954999579, 0.0]}
    bearing:    {type: revolute, bodies: [ground, crank], point: [0.0, 0.0]}
    crank_pin:  {type: revolute, bodies: [crank, rod], point: [0.0, 0.4]}
    slider_pin: {type: revolute, bodies: [rod, slider], point: [0.4472135954999579, 0.0]}
    guide:      {type: prismatic, bodies: [ground, slider], point: [0.4472135954999579, 0.0], axis: [1.0, 0.0]}
    ram: {body: slider, coordinate: x, rate: 0.5}
scene: {start: given}
ts: {max_time: 3.0, dt: 1.0e-3}
)");
  for (const char* type : {"arkimex", "rk"}) {
    const Outcome outcome = workplace.run({"-ts_type", type, "-output_file", "r.h5"});
    EXPECT_NE(outcome.status, 0);
    EXPECT_EQ(outcome.signal, 0);
    for (const char* part : {"vehicle 'press' is locked", "joint '", "driver", "reach"})
      EXPECT_NE(outcome.err.find(part), std::string::npos) << type << ": " << outcome.err;
    // it stops at the instant of full reach, (1 - 0.4472)/0.5 s
    const double last = Results(workplace.path("r.h5")).time().back();
    EXPECT_NEAR(last, (1.0 - 0.4472135954999579) / 0.5, 0.02) << type;
  }
}

/// Nothing is left to integrate: positions, velocities and accelerations all follow from the driver, through the flat
/// positions too.
TEST(Parallelogram, DrivenThroughItsFlatPositions) {
  Results run = run_yaml(R"(
vehicle:
  row:
    bodies: [a, c, b]
    joints: [j1, j2, j3, j4]
    drivers: [motor]
    a: {mass: 1.0, inertia: 0.0833, position: [0.0, 0.5], velocity: [0.5, 0.0, -1.0]}
    c: {mass: 1.0, inertia: 0.0833, position: [0.5, 1.0], velocity: [1.0, 0.0, 0.0]}
    b: {mass: 1.0, inertia: 0.0833, position: [1.0, 0.5], velocity: [0.5, 0.0, -1.0]}
    j1: {type: revolute, bodies: [ground, a], point: [0.0, 0.0]}
    j2: {type: revolute, bodies: [a, c], point: [0.0, 1.0]}
    j3: {type: revolute, bodies: [c, b], point: [1.0, 1.0]}
    j4: {type: revolute, bodies: [b, ground], point: [1.0, 0.0]}
    motor: {body: a, coordinate: phi, rate: -1.0}
train: {vehicles: [row]}
scene: {start: given}
ts: {max_time: 10.0, dt: 0.002}
output: {interval: 0.01}
)");
  const std::vector<double> t = run.time(), angle = run.column("/vehicles/0/b/position", 2),
                            x = run.column("/vehicles/0/c/acceleration", 0),
                            y = run.column("/vehicles/0/c/acceleration", 1);
  double worst = 0.0, worst_acceleration = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    worst = std::max(worst, std::abs(angle[i] + t[i]));
    worst_acceleration =
        std::max({worst_acceleration, std::abs(x[i] + std::sin(t[i])), std::abs(y[i] + std::cos(t[i]))});
  }
  RecordProperty("driven_angle", text(worst));
  RecordProperty("driven_acceleration", text(worst_acceleration));
  EXPECT_LT(worst, 1e-12);
  EXPECT_LT(worst_acceleration, 1e-6);
  EXPECT_LT(energy_error(run), 1e-7);
}

}  // namespace
}  // namespace traverse::test
