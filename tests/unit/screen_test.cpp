// The bound and the passages of a screen: modes with known wavenumbers, bounds that are never below a computed value,
// and verdicts that equal those of all passages.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/random_stream.hpp"
#include "screen/beam_modes.hpp"
#include "screen/pair.hpp"

using namespace traverse;
using namespace traverse::screen;

namespace {

constexpr double kmh = 1.0 / 3.6;

std::vector<double> speeds_to(double last) {
  std::vector<double> speeds;
  for (double speed = 40.0; speed <= last; speed += 2.0) speeds.push_back(speed * kmh);
  return speeds;
}

/// A bridge beside whose axis the track is.
Bridge twisting(Bridge bridge) {
  bridge.eccentricity = 2.2;
  bridge.polar_inertia = 4.0 * bridge.mass;
  bridge.GJ = bridge.polar_inertia * std::pow(2.6 * first_frequency(bridge) * bridge.spans.front(), 2);
  return bridge;
}

/// Random bridges and trains; each draw has a number of its own.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : stream_(seed, "screen_test") {}
  double between(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }

  Bridge bridge() {
    Bridge bridge;
    const int spans = 1 + static_cast<int>(between(0.0, 3.0));
    const double span = between(8.0, 40.0);
    for (int i = 0; i < spans; ++i) bridge.spans.push_back(span * between(0.7, 1.0));
    const double omega = 2.0 * std::numbers::pi * between(0.8, 1.3) * 60.0 / span;
    bridge.mass = between(8e3, 2e4);
    bridge.EI = bridge.mass * omega * omega / std::pow(beam_modes(bridge.spans, 1).front().beta, 4);
    bridge.damping = between(0.005, 0.03);
    bridge.speed = between(150.0, 300.0) * kmh;
    bridge.of_acceleration = 1.0 / 3.5;
    bridge.of_deflection = 600.0;
    return bridge;
  }

  Formation formation() {
    Formation formation;
    formation.speed = between(120.0, 300.0) * kmh;
    const double length = between(14.0, 27.0), load = between(8e4, 2.2e5);
    const int wagons = 1 + static_cast<int>(between(0.0, 9.0));
    for (int i = 0; i < wagons; ++i)
      for (const double at : {0.0, 2.5, length - 7.5, length - 5.0}) {
        formation.distance.push_back(i * length + at);
        formation.loads.push_back(load * between(0.8, 1.2));
      }
    return formation;
  }

 private:
  base::RandomStream stream_;
  std::uint64_t next_ = 0;
};

/// The largest acceleration of a simple span at 301 places and every two-hundredth of the highest mode's period, by the
/// method of Runge and Kutta for three modes.
double largest_acceleration(const Bridge& bridge, const Formation& formation, double v) {
  constexpr int modes = 3, places = 300;
  const double L = bridge.spans[0], pi = std::numbers::pi;
  std::array<double, modes> omega{}, q{}, rate{};
  for (int n = 0; n < modes; ++n) omega[n] = std::pow((n + 1) * pi / L, 2) * std::sqrt(bridge.EI / bridge.mass);
  const double size = std::sqrt(2.0 / (bridge.mass * L)), h = 2.0 * pi / omega[modes - 1] / 200.0;
  const auto acceleration = [&](int n, double t, double value, double slope) {
    double force = 0.0;
    for (std::size_t k = 0; k < formation.loads.size(); ++k)
      if (const double x = v * t - formation.distance[k]; x > 0.0 && x < L)
        force -= formation.loads[k] * size * std::sin((n + 1) * pi * x / L);
    return force - 2.0 * bridge.damping * omega[n] * slope - omega[n] * omega[n] * value;
  };
  double largest = 0.0;
  const double end = (formation.distance.back() + L) / v + 4.0 * pi / omega[0];
  for (double t = 0.0; t < end; t += h) {
    std::array<double, modes> now{};
    for (int n = 0; n < modes; ++n) {
      now[n] = acceleration(n, t, q[n], rate[n]);
      const double r1 = rate[n], a1 = now[n], r2 = r1 + 0.5 * h * a1,
                   a2 = acceleration(n, t + 0.5 * h, q[n] + 0.5 * h * r1, r2), r3 = r1 + 0.5 * h * a2,
                   a3 = acceleration(n, t + 0.5 * h, q[n] + 0.5 * h * r2, r3), r4 = r1 + h * a3,
                   a4 = acceleration(n, t + h, q[n] + h * r3, r4);
      q[n] += h / 6.0 * (r1 + 2.0 * r2 + 2.0 * r3 + r4);
      rate[n] += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    for (int i = 1; i < places; ++i) {
      double sum = 0.0;
      for (int n = 0; n < modes; ++n) sum += size * std::sin((n + 1) * pi * i / places) * now[n];
      largest = std::max(largest, std::abs(sum));
    }
  }
  return largest;
}

}  // namespace

// The places of the stations do not matter: against a fine grid of places and instants, which misses up to 5e-4.
TEST(Screen, FindsPeaksBetweenItsStations) {
  Draws draws(6);
  for (int i = 0; i < 4; ++i) {
    Bridge bridge = draws.bridge();
    bridge.spans.resize(1);
    bridge.speed = 100.0;
    bridge.of_acceleration = 1.0;
    bridge.of_deflection = 0.0;
    Formation formation = draws.formation();
    formation.speed = 100.0;
    const double speed = draws.between(20.0, 70.0), expected = largest_acceleration(bridge, formation, speed);
    for (const int parts : {2, 10, 17}) {
      const BridgeModel model(bridge, 3, parts, {speed}, 20.0);
      const double found = Pairs(model).passages(formation).front();
      EXPECT_GE(found, (1.0 - 1e-4) * expected) << parts;
      EXPECT_LE(found, (1.0 + 5e-4) * expected) << parts;
    }
  }
}

TEST(Screen, ModesOfOneAndOfEqualSpansHaveTheirKnownWavenumbers) {
  const std::vector<double> one = {12.0}, two = {12.0, 12.0};
  const std::vector<BeamMode> simple = beam_modes(one, 3), continuous = beam_modes(two, 4);
  for (int n = 1; n <= 3; ++n)
    EXPECT_NEAR(simple[static_cast<std::size_t>(n - 1)].beta * 12.0, n * std::numbers::pi, 1e-12);
  // Modes without and with a moment at the middle support: pi, and the root of tan = tanh, then both again.
  const double known[] = {std::numbers::pi, 3.926602312047919, 2.0 * std::numbers::pi, 7.068582745628732};
  for (std::size_t n = 0; n < 4; ++n) EXPECT_NEAR(continuous[n].beta * 12.0, known[n], 1e-11);
  EXPECT_NEAR(std::abs(shape_at(simple[0].spans[0], simple[0].beta, 12.0, 6.0)), std::sqrt(2.0 / 12.0), 1e-12);
}

TEST(Screen, TheBoundIsNeverBelowAComputedValue) {
  Draws draws(1);
  std::size_t compared = 0;
  for (int i = 0; i < 12; ++i) {
    const Bridge bridge = draws.bridge();
    const BridgeModel model(i % 2 == 0 ? bridge : twisting(bridge), 3, 10, speeds_to(300.0), 20.0);
    Pairs pairs(model);
    for (int j = 0; j < 4; ++j) {
      const Formation formation = draws.formation();
      const std::vector<double> bounds = pairs.bounds(formation), values = pairs.passages(formation);
      ASSERT_EQ(bounds.size(), values.size());
      for (std::size_t k = 0; k < values.size(); ++k, ++compared) {
        EXPECT_GE(bounds[k], values[k]) << "bridge " << i << ", train " << j << ", speed " << k;
        EXPECT_GT(values[k], 0.0);
      }
    }
  }
  EXPECT_GT(compared, 1000u);
}

TEST(Screen, VerdictsEqualThoseOfAllPassages) {
  Draws draws(2);
  int exceeding = 0;
  for (int i = 0; i < 8; ++i) {
    const Bridge bridge = draws.bridge();
    const BridgeModel model(i % 2 == 0 ? bridge : twisting(bridge), 3, 10, speeds_to(300.0), 20.0);
    Pairs pairs(model);
    for (int j = 0; j < 4; ++j) {
      const Formation formation = draws.formation();
      const std::vector<double> values = pairs.passages(formation);
      const Verdict verdict = pairs.judge(formation);
      const auto first = std::find_if(values.begin(), values.end(), [](double value) { return value > 1.0; });
      const double permitted =
          first == values.begin() ? 0.0 : model.speed(static_cast<std::size_t>(first - values.begin()) - 1);
      EXPECT_EQ(verdict.permitted, permitted);
      EXPECT_EQ(verdict.exceeding, std::count_if(values.begin(), values.end(), [](double v) { return v > 1.0; }));
      const double largest = *std::max_element(values.begin(), values.end());
      EXPECT_NE(verdict.decided_by, DecidedBy::nothing);
      EXPECT_GE(verdict.ratio, (1.0 - 1e-9) * largest);  // a bound, or exact
      const double at_most = verdict.decided_by == DecidedBy::passages ? (1.0 + 1e-9) * largest : verdict.bound;
      EXPECT_LE(verdict.ratio, at_most);
      exceeding += verdict.exceeding > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(exceeding, 0);
}

TEST(Screen, MoreSamplesDoNotChangeThePeaks) {
  Draws draws(3);
  const Bridge bridge = draws.bridge();
  const Formation formation = draws.formation();
  const BridgeModel coarse(bridge, 3, 10, speeds_to(200.0), 20.0), fine(bridge, 3, 10, speeds_to(200.0), 160.0);
  const std::vector<double> a = Pairs(coarse).passages(formation), b = Pairs(fine).passages(formation);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9 * b[i]);
}

TEST(Screen, ASpeedOfNeitherLineNorTrainGivesNoVerdict) {
  Draws draws(4);
  Bridge bridge = draws.bridge();
  bridge.speed = 20.0 * kmh;  // below the first speed of the screen
  const BridgeModel model(bridge, 3, 10, speeds_to(200.0), 20.0);
  const Verdict verdict = Pairs(model).judge(draws.formation());
  EXPECT_EQ(verdict.decided_by, DecidedBy::nothing);
  EXPECT_TRUE(std::isnan(verdict.permitted));
}
