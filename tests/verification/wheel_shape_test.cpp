// Wheels out of round on rigid ground: a polygonal wheel against the exact motion of a mass on a spring whose foot
// moves, a flat against an integration of its own, the energy balance, and a wheel that turns with its body.
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "coupling/system.hpp"
#include "support/curve.hpp"
#include "support/quarter_car.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

double range(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end()) - *std::min_element(values.begin(), values.end());
}

constexpr double pi = std::numbers::pi;
constexpr double R = 0.46, g = 9.81;  // m, m/s2

// One mass on its wheel.
constexpr double mass = 1500.0, stiffness = 2.0e8, speed = 30.0;  // kg, N/m, m/s
constexpr const char* alone = R"(
vehicle:
  axle:
    bodies: [axle]
    wheels: [wheel]
    drivers: [level]
    axle:  {mass: 1500.0, inertia: 100.0, position: [0.0, 0.46]}
    level: {body: axle, coordinate: phi}
    wheel: {body: axle, radius: 0.46, law: linear, stiffness: 2.0e8, polygon_order: 3, polygon_amplitude: 2.0e-5}
train: {vehicles: axle, positions: 3.0, speed: 30.0}
ts: {max_time: 0.1, dt: 5.0e-5}
output: {interval: 1.0e-3}
)";

// m z'' + k z = k A cos(w t) from z = A at rest, where the wheel stands on a crest; force m g + k (A cos(w t) - z).
TEST(PolygonalWheel, ExactForceWithoutDamping) {
  Results run = run_yaml(alone);
  const double A = 2.0e-5, w = 3.0 * speed / R, w0 = std::sqrt(stiffness / mass);
  const double forced = A * w0 * w0 / (w0 * w0 - w * w);
  const std::vector<double> t = run.time(), force = run("/vehicles/0/wheel/normal_force");
  double worst = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double z = forced * std::cos(w * t[i]) + (A - forced) * std::cos(w0 * t[i]);
    worst = std::max(worst, std::abs(force[i] - mass * g - stiffness * (A * std::cos(w * t[i]) - z)));
  }
  RecordProperty("force_error_over_kA", text(worst / (stiffness * A)));
  EXPECT_LT(worst, 1e-7 * stiffness * A);
  EXPECT_LT(peak(run("/energy/residual")).first, 1e-6 * range(run("/energy/kinetic")));
}

// The same with damping, when its start is forgotten: F = (k + i c w) alpha, alpha = -m w^2 A/(k - m w^2 + i c w).
TEST(PolygonalWheel, ExactSteadyForceWithDamping) {
  const double A = 2.0e-5, c = 2.0e5, w = 3.0 * speed / R;
  Results run = run_yaml(
      alone,
      {{"vehicle_axle_wheel_damping", "2e5"}, {"vehicle_axle_wheel_polygon_phase", "0.7"}, {"ts_max_time", "0.4"}});
  const std::complex<double> answer = std::complex<double>(stiffness, c * w) * (-mass * w * w * A) /
                                      std::complex<double>(stiffness - mass * w * w, c * w);
  const std::vector<double> t = run.time(), force = run("/vehicles/0/wheel/normal_force");
  double worst = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i)
    if (t[i] > 0.35)
      worst = std::max(worst, std::abs(force[i] - mass * g - (answer * std::polar(1.0, w * t[i] + 0.7)).real()));
  RecordProperty("force_error_over_amplitude", text(worst / std::abs(answer)));
  EXPECT_LT(worst, 1e-7 * std::abs(answer));
}

// A wheel that turns with its body, by friction, rolls as one that is held.
TEST(PolygonalWheel, TurnsWithItsBody) {
  std::string scene = alone;
  scene.erase(scene.find("    drivers: [level]\n"), std::string("    drivers: [level]\n").size());
  scene.erase(scene.find("    level: {body: axle, coordinate: phi}\n"),
              std::string("    level: {body: axle, coordinate: phi}\n").size());
  Results free = run_yaml(
      scene,
      {{"vehicle_axle_wheel_friction", "0.4"}, {"vehicle_axle_wheel_transition_speed", "1e-3"}, {"ts_dt", "2.5e-5"}});
  Results held = run_yaml(alone, {{"ts_dt", "2.5e-5"}});
  const double angle = free("/vehicles/0/axle/position").back();
  EXPECT_NEAR(angle, -speed * 0.1 / R, 2e-3);
  EXPECT_LT(relative_difference(free("/vehicles/0/wheel/normal_force"), held("/vehicles/0/wheel/normal_force")), 5e-3);
  EXPECT_LT(peak(free("/energy/residual")).first, 1e-6 * range(free("/energy/work")));
}

// The step that is chosen resolves 20 to a wave, here 1.6 ms long, rounded down to 1, 2 or 5.
TEST(PolygonalWheel, IsResolvedByTheChosenStep) {
  std::string scene = alone;
  scene.erase(scene.find(", dt: 5.0e-5"), std::string(", dt: 5.0e-5").size());
  Results run = run_yaml(scene, {{"vehicle_axle_wheel_polygon_order", "60"}});
  Results fine = run_yaml(alone, {{"vehicle_axle_wheel_polygon_order", "60"}, {"ts_dt", "1e-5"}});
  EXPECT_LT(run.attribute("/", "steps"), fine.attribute("/", "steps"));
  EXPECT_NEAR(run.attribute("/summary", "greatest_wheel_force"), fine.attribute("/summary", "greatest_wheel_force"),
              1e-3 * fine.attribute("/summary", "greatest_wheel_force"));
}

// A quarter car with a flat of 60 mm at 20 m/s: the wheel leaves the ground and strikes.
const std::string with_flat = quarter_car_with(5750.0, 1000.0, 1.595e6, 1e4,
                                               "law: hertz, stiffness: 3.64e10, damping: 1.0e5, flat_length: 0.06") +
                              "train: {vehicles: car, positions: 1.0, speed: 20.0}\n"
                              "ts: {max_time: 0.1, dt: 2.0e-5}\n"
                              "output: {interval: 2.5e-4}\n";

// Heights of body and axle above equilibrium at rest, and their rates.
using State = std::array<double, 4>;

struct Reference {
  double load = 6750.0 * g;
  double at_rest = std::pow(load / 3.64e10, 2.0 / 3.0);

  double force(double t, const State& s) const {
    const double L = 0.06, d = L * L / (16.0 * R), from_middle = 20.0 * t - pi * R, k = 2.0 * pi / L;
    const bool on_flat = std::abs(from_middle) < 0.5 * L;
    const double dr = on_flat ? -0.5 * d * (1.0 + std::cos(k * from_middle)) : 0.0;
    const double alpha = at_rest + dr - s[1];
    return alpha > 0.0 ? 3.64e10 * std::pow(alpha, 1.5) : 0.0;
  }
  State rate(double t, const State& s) const {
    const double spring = 1.595e6 * (s[1] - s[0]) + 1.0e4 * (s[3] - s[2]);
    return {s[2], s[3], spring / 5750.0, (-spring + force(t, s) - load) / 1000.0};
  }
  void step(double t, double h, State& s) const {
    const auto moved = [&](const State& k, double by) {
      State m = s;
      for (std::size_t i = 0; i < 4; ++i) m[i] += by * k[i];
      return m;
    };
    const State a = rate(t, s), b = rate(t + 0.5 * h, moved(a, 0.5 * h)), c = rate(t + 0.5 * h, moved(b, 0.5 * h)),
                d = rate(t + h, moved(c, h));
    for (std::size_t i = 0; i < 4; ++i) s[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
};

TEST(Flat, AgainstAnIntegrationOfItsOwn) {
  Results run = run_yaml(with_flat, {{"vehicle_car_wheel_damping", "0"}, {"ts_dt", "1e-5"}});
  const std::vector<double> t = run.time(), force = run("/vehicles/0/wheel/normal_force");
  const Reference reference;
  State s{};
  const int steps = 500;  // a sample
  double worst = 0.0, greatest = 0.0, least = 1e9;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double exact = reference.force(t[i], s);
    worst = std::max(worst, std::abs(force[i] - exact));
    greatest = std::max(greatest, exact);
    least = std::min(least, exact);
    const double h = 2.5e-4 / steps;
    for (int j = 0; j < steps; ++j) reference.step(t[i] + j * h, h, s);
  }
  RecordProperty("force_error_over_greatest", text(worst / greatest));
  RecordProperty("greatest_over_weight", text(greatest / reference.load));
  EXPECT_EQ(least, 0.0);
  EXPECT_GT(greatest, 3.0 * reference.load);
  EXPECT_LT(worst, 1e-5 * greatest);
}

TEST(Flat, EnergyBalances) {
  Results run = run_yaml(with_flat, {{"ts_dt", "1e-5"}});
  const double scale = range(run("/energy/dissipated")) + range(run("/energy/work"));
  RecordProperty("residual_over_scale", text(peak(run("/energy/residual")).first / scale));
  EXPECT_GT(scale, 10.0);
  EXPECT_LT(std::abs(peak(run("/energy/residual")).first), 1e-5 * scale);
}

// Steps end where the ends of the flat meet the rail: half a turn from the start, and once a turn from there.
TEST(Flat, ItsEndsAreKnownEvents) {
  train::Vehicle axle;
  multibody::Body body;
  body.name = "axle";
  body.mass = mass;
  body.inertia = 100.0;
  body.position = {0.0, R, 0.0};
  axle.mechanism.bodies = {body};
  train::Wheel wheel;
  wheel.radius = R;
  wheel.law.stiffness = 1e10;
  wheel.shape.flat_length = 0.05;
  wheel.shape.flat_angle = pi;
  axle.wheels = {wheel};
  coupling::SystemInput input;
  input.types = {axle};
  input.train.vehicles = {0};
  input.train.positions = {7.0};
  input.train.speed = speed;
  const coupling::System system(MPI_COMM_SELF, nullptr, input);
  const double first = pi * R / speed, turn = 2.0 * pi * R / speed, half = 0.025 / speed;
  const std::vector<double> events = system.known_events(1.7 * turn);
  ASSERT_EQ(events.size(), 4u);
  EXPECT_NEAR(events[0], first - half, 1e-12);
  EXPECT_NEAR(events[1], first + half, 1e-12);
  EXPECT_NEAR(events[2], first - half + turn, 1e-12);
  EXPECT_NEAR(events[3], first + half + turn, 1e-12);
}

}  // namespace
}  // namespace traverse::test
