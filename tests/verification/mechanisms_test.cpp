// Classical mechanisms as scenes of their own, run by the program, against elliptic functions, a published solution and
// independent integrations of their reduced equations of motion; and Newton's law for each of their bodies.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "support/curve.hpp"
#include "support/jet.hpp"
#include "support/newton_law.hpp"
#include "support/runge_kutta.hpp"

namespace traverse::test {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr double gravity = 9.81;

// --- pendulum --------------------------------------------------------------------------------------------------------

/// Jacobi's amplitude am(u, k) by the arithmetic-geometric mean (Abramowitz and Stegun 16.4).
double jacobi_amplitude(double u, double k) {
  std::array<double, 12> a{1.0}, c{k};
  double b = std::sqrt(1.0 - k * k);
  std::size_t n = 0;
  for (; n + 1 < a.size() && std::abs(c[n]) > 1e-17; ++n) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
  }
  double phi = std::ldexp(a[n] * u, static_cast<int>(n));
  for (; n > 0; --n) phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  return phi;
}

TEST(Pendulum, TenPeriodsAtALargeAmplitude) {
  const double mass = 2.0, arm = 1.5, amplitude = 2.5, k = std::sin(0.5 * amplitude);
  const double omega = std::sqrt(mass * gravity * arm / (0.3 + mass * arm * arm));
  const double quarter = std::comp_ellint_1(k) / omega;
  Results run = run_scene(
      "pendulum", {{"ts_max_time", text(40.0 * quarter)}, {"ts_dt", "2e-3"}, {"output_interval", text(0.1 * quarter)}});
  const std::vector<double> t = run.time();
  double worst_angle = 0.0, worst_place = 0.0, worst_force = 0.0, largest_force = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    // sin(theta/2) = k sn(K - omega t), from the amplitude at rest
    const double theta = 2.0 * std::asin(k * std::sin(jacobi_amplitude(omega * (quarter - t[i]), k)));
    const double square = 2.0 * omega * omega * (std::cos(theta) - std::cos(amplitude));  // of its rate
    const double second = -omega * omega * std::sin(theta);
    const Vector2d out(std::sin(theta), -std::cos(theta)), along(std::cos(theta), std::sin(theta));
    const Vector2d pin = mass * (arm * second * along - arm * square * out + Vector2d(0.0, gravity));
    const double* q = &run("/vehicles/0/bar/position")[3 * i];
    const double* f = &run("/vehicles/0/pin/reaction")[3 * i];
    worst_angle = std::max(worst_angle, std::abs(q[2] - theta));
    worst_place = std::max(worst_place, (Vector2d(q[0], q[1]) - arm * out).norm());
    worst_force = std::max(worst_force, (Vector2d(f[0], f[1]) - pin).norm());
    largest_force = std::max(largest_force, pin.norm());
    EXPECT_EQ(f[2], 0.0);
  }
  RecordProperty("error", text(worst_angle / amplitude));
  RecordProperty("force_error", text(worst_force / largest_force));
  EXPECT_GE(t.size(), 401u);
  EXPECT_LT(worst_angle, 1e-6 * amplitude);
  EXPECT_LT(worst_place, 1e-6 * arm);
  EXPECT_LT(worst_force, 1e-6 * largest_force);
  EXPECT_LT(energy_error(run), 1e-7);
  expect_newton(run);
}

// --- double pendulum -------------------------------------------------------------------------------------------------

// Upper bar: 1.2 kg, 0.15 kg m2, its centre 0.4 m from the top pin and its lower pin 1.0 m; lower bar 0.8 kg,
// 0.05 kg m2, centre 0.6 m from the pin. Both angles from hanging; the upper starts at pi/2 and the lower at 0.
constexpr const char* double_pendulum = R"(
vehicle:
  pendulum:
    bodies: [upper, lower]
    joints: [top, middle]
    upper: {mass: 1.2, inertia: 0.15, position: [0.4, 0.0]}
    lower: {mass: 0.8, inertia: 0.05, position: [1.0, -0.6]}
    top:    {type: revolute, bodies: [ground, upper], point: [0.0, 0.0]}
    middle: {type: revolute, bodies: [upper, lower], point: [1.0, 0.0]}
scene: {start: given}
ts: {max_time: 3.0, dt: 5.0e-4}
output: {interval: 0.01}
)";

State<4> double_pendulum_rate(const State<4>& y) {
  const double m1 = 1.2, I1 = 0.15, a = 0.4, l = 1.0, m2 = 0.8, I2 = 0.05, b = 0.6;
  const double difference = y[0] - y[1];
  Eigen::Matrix2d M;
  M << I1 + m1 * a * a + m2 * l * l, m2 * l * b * std::cos(difference), m2 * l * b * std::cos(difference),
      I2 + m2 * b * b;
  const Vector2d Q(-m2 * l * b * std::sin(difference) * y[3] * y[3] - (m1 * a + m2 * l) * gravity * std::sin(y[0]),
                   m2 * l * b * std::sin(difference) * y[2] * y[2] - m2 * b * gravity * std::sin(y[1]));
  const Vector2d acceleration = M.inverse() * Q;
  return {y[2], y[3], acceleration[0], acceleration[1]};
}

TEST(DoublePendulum, AgainstItsTwoAngles) {
  Results run = run_yaml(double_pendulum);
  State<4> y(0.5 * pi, 0.0, 0.0, 0.0);
  const int substeps = 1000;
  double worst = 0.0, swung = 0.0;
  const std::vector<double> t = run.time();
  for (std::size_t i = 0; i < t.size(); ++i) {
    ASSERT_NEAR(t[i], 0.01 * static_cast<double>(i), 1e-12);
    worst = std::max(worst, std::abs(run("/vehicles/0/upper/position")[3 * i + 2] + 0.5 * pi - y[0]));
    worst = std::max(worst, std::abs(run("/vehicles/0/lower/position")[3 * i + 2] - y[1]));
    swung = std::max({swung, std::abs(y[0]), std::abs(y[1])});
    for (int k = 0; k < substeps; ++k) runge_kutta<4>(double_pendulum_rate, 0.01 / substeps, y);
  }
  RecordProperty("error", text(worst / swung));
  EXPECT_GT(swung, pi) << "over the top";
  EXPECT_LT(worst, 1e-6 * swung);
  EXPECT_LT(energy_error(run), 1e-7);
  expect_newton(run);
}

// --- one degree of freedom -------------------------------------------------------------------------------------------

/// A body's centre and angle over the crank's angle.
struct Place {
  Jet x, y, phi;
};
struct Inertia {
  double mass, moment;
};
/// Bodies of a mechanism that its crank's angle places, and the generalized force of all that is not gravity.
struct Linkage {
  std::vector<Inertia> bodies;
  std::function<std::vector<Place>(const Jet&)> places;
  std::function<double(const Jet&, double)> force;  // N m, of the crank's angle and its rate
};

/// J theta'' + (sum of m r'.r'' + I phi' phi'') theta'^2 = Q - sum of m g y', where ' is over theta.
State<2> linkage_rate(const Linkage& linkage, const State<2>& y) {
  const Jet theta(y[0], 1.0, 0.0);
  const std::vector<Place> places = linkage.places(theta);
  double J = 0.0, bent = 0.0, Q = linkage.force(theta, y[1]);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [mass, moment] = linkage.bodies[i];
    const auto& [px, py, phi] = places[i];
    J += mass * (px.first * px.first + py.first * py.first) + moment * phi.first * phi.first;
    bent += mass * (px.first * px.second + py.first * py.second) + moment * phi.first * phi.second;
    Q -= mass * gravity * py.first;
  }
  return {y[1], (Q - bent * y[1] * y[1]) / J};
}

struct LinkageError {
  double angle = 0.0, place = 0.0, turned = 0.0;  // rad, m; the crank's angle at the end less that at the start, rad
};
/// The largest differences between a run's bodies and the reduced equation's, integrated in steps of interval/substeps.
LinkageError compare(Results& run, const Linkage& linkage, const std::vector<std::string>& names, State<2> y,
                     double interval, int substeps) {
  LinkageError worst;
  const std::vector<double> t = run.time();
  const double start = y[0];
  for (std::size_t i = 0; i < t.size(); ++i) {
    EXPECT_NEAR(t[i], interval * static_cast<double>(i), 1e-12);
    const std::vector<Place> places = linkage.places(Jet(y[0], 1.0, 0.0));
    for (std::size_t b = 0; b < names.size(); ++b) {
      const std::vector<double>& q = run("/vehicles/0/" + names[b] + "/position");
      worst.place = std::max(worst.place, std::hypot(q[3 * i] - places[b].x.value, q[3 * i + 1] - places[b].y.value));
    }
    worst.angle = std::max(worst.angle, std::abs(run("/vehicles/0/" + names[0] + "/position")[3 * i + 2] -
                                                 run("/vehicles/0/" + names[0] + "/position")[2] - (y[0] - start)));
    worst.turned = y[0] - start;
    for (int k = 0; k < substeps; ++k)
      runge_kutta<2>([&](const State<2>& s) { return linkage_rate(linkage, s); }, interval / substeps, y);
  }
  return worst;
}

TEST(SliderCrank, TurnedByATorqueAgainstASpring) {
  Results run = run_scene("slider_crank");
  const double r = 0.15, l = 0.39;
  const auto slider = [=](const Jet& theta) {
    const Jet height = Jet(r) * sin(theta);
    return Jet(r) * cos(theta) + sqrt(Jet(l * l) - height * height);
  };
  Linkage linkage;
  linkage.bodies = {{2.0, 0.02}, {1.0, 0.015}, {1.5, 0.002}};
  linkage.places = [=](const Jet& theta) {
    const Jet x = Jet(r) * cos(theta), y = Jet(r) * sin(theta), end = slider(theta);
    const Jet third(1.0 / 3.0), two_thirds(2.0 / 3.0);  // the rod's centre is a third of the way from the crank's pin
    return std::vector<Place>{{third * x, third * y, theta},
                              {two_thirds * x + third * end, two_thirds * y, angle(Jet(0.0) - y, end - x)},
                              {end, 0.0, 0.0}};
  };
  linkage.force = [=](const Jet& theta, double rate) {
    const Jet x = slider(theta);
    return 12.0 - (500.0 * (x.value - 0.36) + 20.0 * x.first * rate) * x.first;
  };
  const LinkageError worst = compare(run, linkage, {"crank", "rod", "slider"}, {0.5 * pi, 0.0}, 1e-3, 50);
  RecordProperty("turns", text(worst.turned / (2.0 * pi)));
  RecordProperty("error", text(worst.angle / worst.turned));
  RecordProperty("position_error", text(worst.place / r));
  EXPECT_GT(worst.turned, 6.0 * 2.0 * pi);
  EXPECT_LT(worst.angle, 1e-6 * worst.turned);
  EXPECT_LT(worst.place, 1e-6 * r);
  EXPECT_LT(energy_error(run), 1e-7);
  expect_newton(run);
}

// A crank of 1 m that can turn fully between a rocker of 2.06 m and a coupler of 3.16 m, pivots 3.5 m apart.
constexpr const char* four_bar = R"(
vehicle:
  four_bar:
    bodies: [crank, coupler, rocker]
    joints: [a, b, c, d]
    torsion_springs: [spring]
    crank:   {mass: 3.0, inertia: 0.4, position: [0.0, 0.5], velocity: [-3.25, 0.0, 6.5]}
    coupler: {mass: 2.0, inertia: 1.5, position: [1.5, 1.9], velocity: [-6.05, -0.75, -0.5]}
    rocker:  {mass: 1.5, inertia: 0.7, position: [3.2, 1.1], velocity: [-3.3, -0.9, 3.0]}
    a: {type: revolute, bodies: [ground, crank], point: [0.0, 0.0]}
    b: {type: revolute, bodies: [crank, coupler], point: [0.0, 1.0]}
    c: {type: revolute, bodies: [coupler, rocker], point: [3.0, 2.0]}
    d: {type: revolute, bodies: [rocker, ground], point: [3.5, 0.0]}
    spring: {bodies: [ground, rocker], stiffness: 40.0, damping: 0.5}
scene: {start: given}
ts: {max_time: 4.0, dt: 1.0e-3}
output: {interval: 4.0e-3}
)";

/// A point fixed to the line from `from` to `to`, given by where it is with respect to that line at the start.
struct Fixed {
  double along, across;
  Fixed(const Vector2d& from, const Vector2d& to, const Vector2d& point) {
    const Vector2d line = to - from, arm = point - from;
    along = arm.dot(line) / line.squaredNorm();
    across = (line.x() * arm.y() - line.y() * arm.x()) / line.squaredNorm();
  }
  Place at(const Jet& x0, const Jet& y0, const Jet& x1, const Jet& y1) const {
    const Jet dx = x1 - x0, dy = y1 - y0, a(along), c(across);
    return {x0 + a * dx - c * dy, y0 + a * dy + c * dx, angle(dy, dx)};
  }
};

TEST(FourBar, CrankAndRockerOverSeveralTurns) {
  Results run = run_yaml(four_bar);
  const Vector2d A(0.0, 0.0), B(0.0, 1.0), C(3.0, 2.0), D(3.5, 0.0);
  const double coupler = (C - B).squaredNorm(), rocker = (C - D).squaredNorm();
  const Fixed crank_centre(A, B, {0.0, 0.5}), coupler_centre(B, C, {1.5, 1.9}), rocker_centre(D, C, {3.2, 1.1});
  Linkage linkage;
  linkage.bodies = {{3.0, 0.4}, {2.0, 1.5}, {1.5, 0.7}};
  linkage.places = [=](const Jet& theta) {
    const Jet bx = cos(theta), by = sin(theta), dx = Jet(D.x()) - bx, dy = Jet(0.0) - by, square = dx * dx + dy * dy;
    // where the circles about B and D meet, above the line from B to D
    const Jet along = (Jet(coupler - rocker) + square) / (Jet(2.0) * square);
    const Jet across = sqrt(Jet(coupler) / square - along * along);
    const Jet cx = bx + along * dx - across * dy, cy = by + along * dy + across * dx;
    return std::vector<Place>{crank_centre.at(0.0, 0.0, bx, by), coupler_centre.at(bx, by, cx, cy),
                              rocker_centre.at(D.x(), 0.0, cx, cy)};
  };
  const double rocker_start = std::atan2(C.y() - D.y(), C.x() - D.x());
  linkage.force = [=](const Jet& theta, double rate) {
    const Jet phi = linkage.places(theta)[2].phi;
    return -(40.0 * (phi.value - rocker_start) + 0.5 * phi.first * rate) * phi.first;
  };
  EXPECT_NEAR(run("/vehicles/0/crank/velocity")[2], 6.5, 1e-12) << "velocities that fit the constraints stay";
  const LinkageError worst = compare(run, linkage, {"crank", "coupler", "rocker"}, {0.5 * pi, 6.5}, 4e-3, 100);
  RecordProperty("turns", text(worst.turned / (2.0 * pi)));
  RecordProperty("error", text(worst.angle / worst.turned));
  RecordProperty("position_error", text(worst.place));
  EXPECT_GT(worst.turned, 3.0 * 2.0 * pi);
  EXPECT_LT(worst.angle, 1e-6 * worst.turned);
  EXPECT_LT(worst.place, 1e-6);
  EXPECT_LT(energy_error(run), 1e-7);
  expect_newton(run);
}

// --- R9 --------------------------------------------------------------------------------------------------------------

// The reference of the IVP test set, computed with PSIDE at tolerances of 1e-14: angles and rates at 0.03 s.
TEST(R9, AndrewsSqueezingMechanism) {
  Results run = run_scene("r9_andrews");
  const double beta = 15.81077119629904, theta = -15.75637105984298, gamma = 0.04082224013073101;
  const double phi = -0.5347301163226948, delta = 0.5244099658805304, omega = 0.5347301163226948;
  const double epsilon = 1.048080741042263;
  const std::array<double, 7> angles = {beta, beta + theta, gamma, phi + delta, delta, omega + epsilon, epsilon};
  const double beta_rate = 1139.920302151208, theta_rate = -1424.379294994111, gamma_rate = 11.03291221937134;
  const double phi_rate = 19.29337464421385, delta_rate = 0.5735699284790808, epsilon_rate = 0.3231791658026955;
  const std::array<double, 7> rates = {beta_rate,  beta_rate + theta_rate,  gamma_rate,  phi_rate + delta_rate,
                                       delta_rate, epsilon_rate - phi_rate, epsilon_rate};
  EXPECT_NEAR(run.time().back(), 0.03, 1e-15);
  double worst_angle = 0.0, worst_rate = 0.0;
  for (std::size_t k = 0; k < 7; ++k) {
    const std::string body = "/vehicles/0/k" + std::to_string(k + 1);
    const double angle_error = run.column(body + "/position", 2).back() - angles[k];
    RecordProperty("k" + std::to_string(k + 1), text(angle_error));
    worst_angle = std::max(worst_angle, std::abs(angle_error));
    worst_rate = std::max(worst_rate, std::abs(run.column(body + "/velocity", 2).back() - rates[k]));
  }
  RecordProperty("error", text(worst_angle / beta));
  RecordProperty("rate_error", text(worst_rate / beta_rate));
  EXPECT_LT(worst_angle, 1e-8);
  EXPECT_LT(worst_rate, 1e-5);
  EXPECT_LT(energy_error(run), 1e-7);
  expect_newton(run);
}

// --- a free-floating mechanism ---------------------------------------------------------------------------------------

constexpr const char* satellite = R"(
vehicle:
  satellite:
    bodies: [hub, tank, boom, sleeve, arm, tip]
    joints: [seam, hinge, rail, track, rod, elbow]
    springs: [boom_spring, tether]
    torsion_springs: [coil]
    hub:    {mass: 30.0, inertia: 9.0, position: [0.0, 0.0], velocity: [0.3, -0.2, 1.5]}
    tank:   {mass: 6.0, inertia: 0.5, position: [-1.0, 0.3]}
    boom:   {mass: 5.0, inertia: 4.0, position: [2.0, 0.0], velocity: [0.0, 2.0, 0.0]}
    sleeve: {mass: 2.0, inertia: 0.1, position: [2.5, 0.0], velocity: [1.0, 0.0, 0.0]}
    arm:    {mass: 3.0, inertia: 1.0, position: [0.0, -2.0], velocity: [1.5, 0.0, 0.0]}
    tip:    {mass: 1.0, inertia: 0.1, position: [0.5, -3.0], velocity: [0.0, 0.0, -2.0]}
    seam:  {type: weld, bodies: [hub, tank], point: [-0.7, 0.2]}
    hinge: {type: revolute, bodies: [hub, boom], point: [0.8, 0.0]}
    rail:  {type: prismatic, bodies: [boom, sleeve], point: [2.5, 0.0], axis: [1.0, 0.0]}
    track: {type: slot, bodies: [hub, arm], point: [0.0, -1.0], axis: [1.0, 0.2]}
    rod:   {type: distance, bodies: [sleeve, arm], from: [2.5, -0.2], to: [0.3, -2.2]}
    elbow: {type: revolute, bodies: [arm, tip], point: [0.3, -2.8]}
    boom_spring: {bodies: [boom, sleeve], from: [1.0, 0.0], to: [2.5, 0.0], stiffness: 60.0}
    tether: {bodies: [tank, arm], from: [-1.2, 0.0], to: [-0.3, -2.0], stiffness: 25.0, free_length: 1.8}
    coil:   {bodies: [hub, boom], stiffness: 80.0, free_angle: 0.2}
scene: {start: given}
gravity: 0.0
ts: {max_time: 1.9, dt: 2.0e-3}
output: {interval: 0.02}
)";

void expect_conservation(Results run) {
  const std::vector<std::string> names = {"hub", "tank", "boom", "sleeve", "arm", "tip"};
  const std::vector<Inertia> bodies = {{30.0, 9.0}, {6.0, 0.5}, {5.0, 4.0}, {2.0, 0.1}, {3.0, 1.0}, {1.0, 0.1}};
  Vector2d first_momentum(0.0, 0.0);
  double first_spin = 0.0, worst = 0.0, worst_spin = 0.0, scale = 0.0, spin_scale = 0.0;
  for (std::size_t i = 0; i < run.time().size(); ++i) {
    Vector2d momentum(0.0, 0.0);
    double spin = 0.0, size = 0.0, spin_size = 0.0;
    for (std::size_t b = 0; b < names.size(); ++b) {
      const double* q = &run("/vehicles/0/" + names[b] + "/position")[3 * i];
      const double* v = &run("/vehicles/0/" + names[b] + "/velocity")[3 * i];
      const auto [mass, moment] = bodies[b];
      momentum += mass * Vector2d(v[0], v[1]);
      spin += mass * (q[0] * v[1] - q[1] * v[0]) + moment * v[2];
      size += mass * std::hypot(v[0], v[1]);
      spin_size += mass * std::abs(q[0] * v[1] - q[1] * v[0]) + std::abs(moment * v[2]);
    }
    if (i == 0) first_momentum = momentum;
    if (i == 0) first_spin = spin;
    worst = std::max(worst, (momentum - first_momentum).norm());
    worst_spin = std::max(worst_spin, std::abs(spin - first_spin));
    scale = std::max(scale, size);
    spin_scale = std::max(spin_scale, spin_size);
  }
  const double energy = energy_error(run);
  testing::Test::RecordProperty("momentum", text(worst / scale));
  testing::Test::RecordProperty("angular_momentum", text(worst_spin / spin_scale));
  testing::Test::RecordProperty("energy", text(energy));
  EXPECT_LT(worst, 1e-8 * scale);
  EXPECT_LT(worst_spin, 1e-8 * spin_scale);
  EXPECT_LT(energy, 1e-8);
  EXPECT_GT(peak(run("/energy/strain")).first, 1.0);
  expect_newton(run);
}

TEST(FreeFloating, KeepsItsMomentumAngularMomentumAndEnergy) { expect_conservation(run_yaml(satellite)); }

TEST(FreeFloating, KeepsThemByAnExplicitMethodToo) {
  expect_conservation(run_yaml(satellite, {{"ts_type", "rk"}, {"ts_rk_type", "5dp"}, {"ts_max_time", "5.0"}}));
}

}  // namespace
}  // namespace traverse::test
