// Rayleigh damping of beams with springs, tension and a track: a and b against closed forms, the ratios of the modes,
// and the decay of a free vibration.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/scene_run.hpp"
#include "traverse/base/error.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

constexpr double L = 20.0, EI = 9e9, m = 1.5e4, zeta = 0.02;

/// (n pi/L)^4 EI/m, the squared frequency of a simple span, 1/s2.
double bending(int n, double mass = m) { return std::pow(n * pi / L, 4) * EI / mass; }

struct Pair {
  double a, b;
};
/// 2 zeta omega_i = a + b k_i for two modes.
Pair solve(double omega1, double k1, double omega2, double k2) {
  const double b = 2.0 * zeta * (omega2 - omega1) / (k2 - k1);
  return {2.0 * zeta * omega1 - b * k1, b};
}

constexpr const char* simple_span = R"(
beam: {spans: 20.0, EI: 9.0e9, mass: 1.5e4, damping_ratios: 0.02, elements_per_span: 24}
load: {forces: 2.0e5, speed: 45.0}
scene: {analysis: modes}
modes: {count: 3}
)";

// A bed adds k/m to the square of each frequency and nothing to the strain energy of the beam.
TEST(RayleighDamping, OnABed) {
  const double bed = 2.5e6;
  Results run = run_yaml(simple_span, {{"foundation_vertical_bed_k", "2.5e6"}});
  const auto omega = [&](int n) { return std::sqrt(bending(n) + bed / m); };
  const auto [a, b] = solve(omega(1), bending(1), omega(2), bending(2));
  EXPECT_NEAR(run.attribute("/modes", "rayleigh_a") / a, 1.0, 1e-4);
  EXPECT_NEAR(run.attribute("/modes", "rayleigh_b") / b, 1.0, 1e-4);
  const double third = (a + b * bending(3)) / (2.0 * omega(3));
  EXPECT_NEAR(run("/modes/ratio_by_beam")[0], zeta, 1e-9);
  EXPECT_NEAR(run("/modes/ratio_by_beam")[1], zeta, 1e-9);
  EXPECT_NEAR(run("/modes/ratio_by_beam")[2] / third, 1.0, 1e-4);
  EXPECT_NEAR(run("/modes/damping_ratio")[0], zeta, 1e-6);
  EXPECT_EQ(run("/modes/ratio_by_dampers")[2], 0.0);
}

// A tension T adds (n pi/L)^2 T/m; compression takes it away.
TEST(RayleighDamping, UnderTension) {
  for (const double T : {4e7, -1.5e8}) {
    Results run = run_yaml(simple_span, {{"beam_tension", std::to_string(T)}});
    const auto omega = [&](int n) { return std::sqrt(bending(n) + std::pow(n * pi / L, 2) * T / m); };
    const auto [a, b] = solve(omega(1), bending(1), omega(2), bending(2));
    EXPECT_NEAR(run.attribute("/modes", "rayleigh_a") / a, 1.0, 1e-4);
    EXPECT_NEAR(run.attribute("/modes", "rayleigh_b") / b, 1.0, 1e-4);
    EXPECT_NEAR(run("/modes/damping_ratio")[1], zeta, 1e-6);
  }
}

// The ballast on a bridge adds to the mass, which a does not damp: a (m/(m + m_s)) = 2 zeta omega_1 omega_2/(sum).
TEST(RayleighDamping, UnderALayeredTrack) {
  Results run = run_yaml(R"(
beam: {spans: 20.0, EI: 9.0e9, mass: 1.5e4, damping_ratios: 0.02, elements_per_span: 20}
track:
  approach: 5.0
  spacing: 0.5
  rail: {EI: 6.0e6, mass: 60.0}
  pad: {k: 1.0e9}
  sleeper: {mass: 1.0}
  ballast: {mass: 1500.0, k: 1.0e9}
  subballast: {k: 1.0e9}
load: {forces: 2.0e5, speed: 45.0}
scene: {analysis: modes}
modes: {count: 1}
)");
  const double whole = m + 1500.0 / 0.5, omega1 = std::sqrt(bending(1, whole)), omega2 = std::sqrt(bending(2, whole));
  EXPECT_NEAR(run.attribute("/modes", "rayleigh_a") * m / whole / (2.0 * zeta * omega1 * omega2 / (omega1 + omega2)),
              1.0, 1e-4);
  EXPECT_NEAR(run.attribute("/modes", "rayleigh_b") / (2.0 * zeta / (omega1 + omega2)), 1.0, 1e-4);
}

// With given frequencies the ratios are those of the motion at these frequencies: on a bed exactly of modes 1 and 3.
TEST(RayleighDamping, AtGivenFrequencies) {
  const double bed = 2.5e6;
  const auto hertz = [&](int n) { return std::sqrt(bending(n) + bed / m) / (2.0 * pi); };
  Results run =
      run_yaml(simple_span, {{"foundation_vertical_bed_k", "2.5e6"},
                             {"beam_damping_frequencies", std::to_string(hertz(1)) + "," + std::to_string(hertz(3))}});
  EXPECT_NEAR(run("/modes/damping_ratio")[0], zeta, 1e-6);
  EXPECT_NEAR(run("/modes/damping_ratio")[2], zeta, 1e-5);
  EXPECT_LT(run("/modes/damping_ratio")[1], 0.99 * zeta);
}

constexpr const char* on_springs = R"(
beam: {spans: 20.0, EI: 9.0e9, mass: 1.5e4, damping_ratios: 0.02, elements_per_span: 16}
support: {types: [free, free]}
foundation: {vertical: {x: [0.0, 20.0], k: 2.5e8}}
load: {forces: 2.0e5, speed: 45.0}
scene: {analysis: modes}
modes: {count: 4}
)";

TEST(RayleighDamping, OnElasticBearings) {
  Results run = run_yaml(on_springs);
  EXPECT_NEAR(run("/modes/damping_ratio")[0], zeta, 2e-5);
  EXPECT_NEAR(run("/modes/damping_ratio")[1], zeta, 2e-5);
  EXPECT_NEAR(run("/modes/ratio_by_beam")[2], 0.0222993, 1e-6);  // dense matrices of the same elements, by NumPy
  EXPECT_NEAR(run("/modes/ratio_by_beam")[3], 0.0636360, 1e-6);
}

// On soft springs the second mode bends the beam less than the first, so that no a, b >= 0 damp both alike.
TEST(RayleighDamping, SoftSpringsTakeTheNextMode) {
  for (const char* k : {"1e8", "5e7", "5e6", "1e4"}) {
    Results run = run_yaml(on_springs, {{"foundation_vertical_k", k}});
    const std::vector<double>& ratio = run("/modes/ratio_by_beam");
    EXPECT_GE(run.attribute("/modes", "rayleigh_a"), 0.0);
    EXPECT_GE(run.attribute("/modes", "rayleigh_b"), 0.0);
    EXPECT_NEAR(ratio[0], zeta, 1e-8) << k;
    EXPECT_NEAR(ratio[2], zeta, 1e-8) << k;
    EXPECT_LT(ratio[1], zeta) << k;
    EXPECT_GT(ratio[1], 0.2 * zeta) << k;
  }
}

// Many springs under free ends: the first modes are rigid motions to rounding, at frequencies that hardly differ.
TEST(RayleighDamping, RigidMotionsOnManySprings) {
  Results run = run_yaml(R"(
beam: {spans: 20.0, EI: 9.0e11, mass: 1.5e4, damping_ratios: 0.02, elements_per_span: 20}
support: {types: [free, free]}
foundation: {vertical: {x: [0.0, 20.0], spacing: 1.0, k: 1.0e6}}
load: {forces: 2.0e5, speed: 45.0}
scene: {analysis: modes}
modes: {count: 4}
)");
  const std::vector<double>& ratio = run("/modes/ratio_by_beam");
  EXPECT_NEAR(ratio[0], zeta, 1e-6);
  for (const double one : ratio) {
    EXPECT_GT(one, 0.0);
    EXPECT_LT(one, 0.2);
  }
}

TEST(RayleighDamping, UnequalRatiosAreRefusedWhereTheyFeedEnergy) {
  EXPECT_THROW(run_yaml(on_springs, {{"foundation_vertical_k", "5e7"}, {"beam_damping_ratios", "0.02,0.021"}}),
               InputError);
}

// The energy of the free vibration of the first mode decays with exp(-2 zeta omega t).
TEST(RayleighDamping, DecayOfAFreeVibration) {
  const double bed = 2.5e6, omega = std::sqrt(bending(1) + bed / m), period = 2.0 * pi / omega;
  Results run = run_yaml(simple_span, {{"foundation_vertical_bed_k", "2.5e6"},
                                       {"beam_elements_per_span", "4"},
                                       {"scene_analysis", "transient"},
                                       {"load_speed", "20.0"},
                                       {"beam_damping_ratios", "0.03"},
                                       {"scene_tail", std::to_string(30.0 * period)},
                                       {"output_interval", std::to_string(period / 40.0)},
                                       {"ts_dt", std::to_string(period / 80.0)}});
  const std::vector<double> time = run.time(), kinetic = run("/energy/kinetic"), strain = run("/energy/strain");
  const auto mean = [&](double from) {  // energy and time, over the 40 samples of a period
    const auto first = static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), from) - time.begin());
    double energy = 0.0, instant = 0.0;
    for (std::size_t i = first; i < first + 40; ++i) {
      energy += (kinetic[i] + strain[i]) / 40.0;
      instant += time[i] / 40.0;
    }
    return std::pair(energy, instant);
  };
  const auto [early, t1] = mean(L / 20.0 + 12.0 * period);
  const auto [late, t2] = mean(L / 20.0 + 22.0 * period);
  EXPECT_NEAR(std::log(early / late) / (2.0 * omega * (t2 - t1)), 0.03, 3e-5);
}

}  // namespace
}  // namespace traverse::test
