// Contacts that pull: oscillation on rigid ground against its closed form, and a magnet over a bridge against an own
// integration of the modes of a simply supported beam.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/message.hpp"
#include "support/runge_kutta.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;
constexpr double mass = 1000.0, stiffness = 4.0e5, gravity = 9.81, radius = 0.4;  // kg, N/m, m/s2, m

/// A mass on a two-sided contact that starts `height` above the surface.
std::string magnet(double height, double damping) {
  return "vehicle:\n  magnet:\n    bodies: [body]\n    drivers: [level]\n    wheels: [gap]\n    body: {mass: 1000, "
         "inertia: 10, "
         "position: [0.0, " +
         std::to_string(radius + height) +
         "]}\n    level: {body: body, coordinate: phi, value: 0.0}\n    gap: {body: body, radius: 0.4, law: two_sided, "
         "stiffness: 4.0e5, damping: " +
         std::to_string(damping) + "}\ntrain: {vehicles: magnet, positions: 0.0, speed: 15.0}\nscene: {start: given}\n";
}

TEST(TwoSidedContact, OscillatesWithoutLoss) {
  Results run = run_yaml(magnet(0.05, 0.0) + "ts: {dt: 2.0e-3, max_time: 2.0}\noutput: {interval: 0.01}\n");
  const std::vector<double> time = run.time(), force = run.column("/vehicles/0/gap/normal_force");
  const double omega = std::sqrt(stiffness / mass), weight = mass * gravity;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double exact = weight - (weight + stiffness * 0.05) * std::cos(omega * time[i]);
    EXPECT_NEAR(force[i], exact, 1e-6 * weight) << time[i];
  }
  EXPECT_LT(*std::min_element(force.begin(), force.end()), -1.9 * weight);
  EXPECT_EQ(run.attribute("/summary", "contact_losses"), 0.0);
  EXPECT_LT(energy_error(run), 1e-8);
}

// q_n of the beam's modes, the body's height z over its undeformed contact, and their rates.
TEST(TwoSidedContact, OverABridge) {
  constexpr double length = 20.0, EI = 8.0e8, per_length = 2000.0, speed = 15.0, damping = 4.0e3;
  constexpr int modes = 20, n = 2 * modes + 2;
  Results run = run_yaml(magnet(0.05, damping) +
                         "beam: {spans: 20, EI: 8.0e8, mass: 2000, elements_per_span: 20}\nsupport: {types: [pinned, "
                         "roller]}\nts: {dt: 5.0e-4, max_time: 1.3}\noutput: {probes: 10.0, interval: 0.01}\n");
  const std::vector<double> time = run.time(), force = run.column("/vehicles/0/gap/normal_force"),
                            deflection = run.column("/probes/deflection");
  State<n> y = State<n>::Zero();
  y[modes] = 0.05;
  double t = 0.0, contact = 0.0;
  const auto rate = [&](const State<n>& s) {
    State<n> d;
    double w = 0.0, w_rate = 0.0;
    for (int i = 0; i < modes; ++i) {
      const double k = (i + 1) * pi / length, angle = k * speed * t;
      w += s[i] * std::sin(angle);
      w_rate += s[modes + 1 + i] * std::sin(angle) + s[i] * k * speed * std::cos(angle);
    }
    contact = stiffness * (w - s[modes]) + damping * (w_rate - s[n - 1]);
    for (int i = 0; i < modes; ++i) {
      const double k = (i + 1) * pi / length, omega = k * k * std::sqrt(EI / per_length);
      d[i] = s[modes + 1 + i];
      d[modes + 1 + i] = -omega * omega * s[i] - contact * std::sin(k * speed * t) / (0.5 * per_length * length);
    }
    d[modes] = s[n - 1];
    d[n - 1] = contact / mass - gravity;
    return d;
  };
  constexpr int steps = 400;  // between stored samples
  double largest = 0.0, error = 0.0, force_error = 0.0, least = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    double middle = 0.0;
    for (int k = 0; k < modes; ++k) middle += y[k] * std::sin((k + 1) * pi * 0.5);
    rate(y);
    largest = std::max(largest, std::abs(middle));
    error = std::max(error, std::abs(middle - deflection[i]));
    force_error = std::max(force_error, std::abs(contact - force[i]));
    least = std::min(least, contact);
    const double h = (i + 1 < time.size() ? time[i + 1] - time[i] : 0.0) / steps;
    for (int k = 0; k < steps; ++k) {
      // the contact moves within the step, so that each stage has its own time
      const double begin = t;
      const State<n> a = rate(y);
      t = begin + 0.5 * h;
      const State<n> b = rate(y + 0.5 * h * a), c = rate(y + 0.5 * h * b);
      t = begin + h;
      const State<n> d = rate(y + h * c);
      y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
  }
  EXPECT_LT(least, -1e3);  // it pulls
  EXPECT_LT(error, 3e-4 * largest);
  EXPECT_LT(force_error, 3e-4 * (mass * gravity + stiffness * 0.05));
  EXPECT_LT(energy_error(run), 1e-5);
}

TEST(TwoSidedContact, RefusesWhatNeedsOneSide) {
  std::string scene = magnet(0.0, 0.0);
  const std::string damping = "damping: " + std::to_string(0.0);
  scene.replace(scene.find(damping), damping.size(), "restitution: 0.5");
  EXPECT_TRUE(contains(message_of([&] { run_yaml(scene); }), "not for law two_sided"));
}

}  // namespace
}  // namespace traverse::test
