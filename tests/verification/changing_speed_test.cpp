// A force and a mass that start and stop on a span, against an own integration by modes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr double pi = std::numbers::pi;

/// Own integration by three modes of a simply supported span, q_n'' + 2 zeta omega q_n' + omega^2 q_n = f phi_n(x)/(m
/// L/2), by the classical Runge-Kutta method; what the modes left out add is
/// static, and no wheel sees it, as the program has it.
struct Span {
  static constexpr int modes = 3;
  static constexpr double length = 30.0, EI = 8.33e9, mass = 2303.0, zeta = 0.02;
  using State = std::array<double, 2 * modes + 2>;  // with two numbers more

  static double shape(int n, double x) { return x < 0.0 || x > length ? 0.0 : std::sin((n + 1) * pi * x / length); }
  static double omega(int n) { return std::pow((n + 1) * pi / length, 2) * std::sqrt(EI / mass); }
  /// What the modes left out deflect p by under a unit force at x.
  static double left_out(double x, double p) {
    const double near = std::min(x, p), b = length - std::max(x, p);
    double sum = b * near * (length * length - b * b - near * near) / (6.0 * length * EI);
    for (int n = 0; n < modes; ++n) sum -= shape(n, x) * shape(n, p) / (0.5 * mass * length * omega(n) * omega(n));
    return sum;
  }
  static double by_modes(const State& y, double x) {
    double sum = 0.0;
    for (int n = 0; n < modes; ++n) sum += y[n] * shape(n, x);
    return sum;
  }

  /// Deflections at `probe` every `interval`, under a force downward at a place.
  template <class Place, class Force, class Rest>
  static std::vector<double> deflections(State y, double end, double interval, double probe, Place&& place_of,
                                         Force&& force, Rest&& rest) {
    constexpr int steps = 100;  // an interval
    const auto rate = [&](double t, const State& at) {
      State r = modal_rate(at, force(t, at), place_of(t));
      rest(force(t, at), at, r);
      return r;
    };
    const auto moved = [](State a, double h, const State& b) {
      for (std::size_t i = 0; i < a.size(); ++i) a[i] += h * b[i];
      return a;
    };
    std::vector<double> found;
    for (int k = 0; k <= std::lround(end / interval); ++k) {
      const double h = interval / steps, begin = k * interval;
      found.push_back(by_modes(y, probe) - force(begin, y) * left_out(place_of(begin), probe));
      for (int i = 0; i < steps; ++i) {
        const double t = begin + i * h;
        const State a = rate(t, y), b = rate(t + 0.5 * h, moved(y, 0.5 * h, a)),
                    c = rate(t + 0.5 * h, moved(y, 0.5 * h, b)), d = rate(t + h, moved(y, h, c));
        for (std::size_t j = 0; j < y.size(); ++j) y[j] += h / 6.0 * (a[j] + 2.0 * b[j] + 2.0 * c[j] + d[j]);
      }
    }
    return found;
  }

  /// Of the modes under a force (downward) at x.
  static State modal_rate(const State& y, double force, double x) {
    State rate{};
    for (int n = 0; n < modes; ++n) {
      rate[n] = y[modes + n];
      rate[modes + n] = -2.0 * zeta * omega(n) * y[modes + n] - omega(n) * omega(n) * y[n] -
                        force * shape(n, x) / (0.5 * mass * length);
    }
    return rate;
  }
};

/// From rest at x = 3 m to 20 m/s, on, and to rest before the end of the span; its kinks lie on stored samples.
constexpr const char* start_and_stop = "0,0\n1,10\n1.5,10\n2.5,0\n";
double place(double t) {
  if (t < 1.0) return 3.0 + 5.0 * t * t;
  if (t < 1.5) return 8.0 + 10.0 * (t - 1.0);
  if (t < 2.5) return 13.0 + 10.0 * (t - 1.5) - 5.0 * (t - 1.5) * (t - 1.5);
  return 18.0;
}
double speed(double t) { return t < 1.0 ? 10.0 * t : t < 1.5 ? 10.0 : t < 2.5 ? 10.0 - 10.0 * (t - 1.5) : 0.0; }

const std::string span = R"(
beam: {spans: 30.0, EI: 8.33e9, mass: 2303.0, elements_per_span: 120}
support: {types: [pinned, roller]}
model: {modes: 3, damping_ratios: 0.02}
ts_dt: 5.0e-4
ts_max_time: 3.5
output: {interval: 0.01, probes: 14.3}
)";

TEST(Trains, ForceAtAChangingSpeedAgainstOwnModes) {
  const TemporaryFolder folder;
  const std::string file = folder.write("speed.csv", start_and_stop);
  Results run = run_yaml(
      span, {{"load_forces", "1e5"}, {"load_positions", "3"}, {"load_speed_file", file}, {"scene_start", "given"}});
  const std::vector<double> own = Span::deflections(
      {}, 3.5, 0.01, 14.3, place, [](double, const Span::State&) { return 1e5; },
      [](double, const Span::State&, Span::State&) {});
  const double error = relative_difference(run("/probes/deflection"), own);
  testing::Test::RecordProperty("error", text(error));
  EXPECT_LT(error, 1e-6);
}

// A mass on a linear contact: its height and its rate are the two numbers more. Gravity is small and so is the wheel,
// which touches beside its centre by radius times slope.
TEST(Trains, MassAtAChangingSpeedAgainstOwnModes) {
  const TemporaryFolder folder;
  const std::string file = folder.write("speed.csv", start_and_stop);
  constexpr int height = 2 * Span::modes;
  constexpr double mass = 2.0e4, stiffness = 5.0e7, gravity = 0.0981;
  const std::string vehicle = R"(
vehicle:
  mass:
    bodies: [body]
    drivers: [level]
    wheels: [wheel]
    body: {mass: 2.0e4, inertia: 1.0e3, position: [0.0, 0.05]}
    level: {body: body, coordinate: phi, value: 0.0}
    wheel: {body: body, radius: 0.05, law: linear, stiffness: 5.0e7}
train: {vehicles: mass, positions: 3.0}
gravity: 0.0981
)";
  Results run = run_yaml(span + vehicle, {{"train_speed_file", file}});
  Span::State y{};  // at rest, with the height of the mass and its rate
  for (int n = 0; n < Span::modes; ++n)
    y[n] = -mass * gravity * Span::shape(n, 3.0) / (0.5 * Span::mass * Span::length * Span::omega(n) * Span::omega(n));
  y[height] = Span::by_modes(y, 3.0) - mass * gravity / stiffness;
  const auto force = [&](double t, const Span::State& s) {
    return stiffness * (Span::by_modes(s, place(t)) - s[height]);
  };
  const auto rest = [&](double f, const Span::State& s, Span::State& rate) {
    rate[height] = s[height + 1];
    rate[height + 1] = f / mass - gravity;
  };
  const std::vector<double> own = Span::deflections(y, 3.5, 0.01, 14.3, place, force, rest);
  const double error = relative_difference(run("/probes/deflection"), own);
  testing::Test::RecordProperty("error", text(error));
  EXPECT_LT(error, 1e-6);
  EXPECT_NEAR(run.column("/vehicles/0/body/velocity", 0)[50], speed(0.5), 1e-12);
  EXPECT_LT(energy_error(run), 1e-8);
}

}  // namespace
}  // namespace traverse::test
