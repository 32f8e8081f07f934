// Bearings that slide where the force on them reaches their friction: at rest and in time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/quarter_car.hpp"
#include "support/record.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr double EA = 1.2e10, length = 30.0, fixed_k = 4e8, sliding_k = 2e8, limit = 1.5e5;

/// A deck between a fixed bearing and one that slides.
const std::string deck = R"(
beam: {spans: 30.0, EI: 2.0e10, EA: 1.2e10, mass: 5000.0, elements_per_span: 6}
support: {types: [roller, roller]}
foundation: {longitudinal: {x: [0.0, 30.0], k: [4.0e8, 2.0e8], limit: [0.0, 1.5e5]}}
output: {probes: [0.0, 30.0]}
)";

}  // namespace

// A warm deck: one force N through both bearings, which the sliding one ends.
TEST(SlidingBearings, HoldAWarmDeckUpToTheirFriction) {
  double error = 0.0;
  for (const double warmer : {1.0, 10.0, -40.0}) {
    Results run = run_yaml(deck, {{"scene_analysis", "static"},
                                  {"beam_temperature_uniform", std::to_string(warmer)},
                                  {"beam_temperature_expansion", "1e-5"}});
    const double lengthens = 1e-5 * warmer * length;
    const double held = lengthens / (1.0 / fixed_k + length / EA + 1.0 / sliding_k);
    const double N = std::clamp(held, -limit, limit);  // compression
    const std::vector<double> wanted = {-N / fixed_k, lengthens - N * (1.0 / fixed_k + length / EA)};
    error = std::max(error, relative_difference(run("/probes/axial_displacement"), wanted));
    error = std::max(error, relative_difference(run("/foundation/longitudinal/force"), {N, -N}));
    EXPECT_EQ(std::abs(held) > limit, warmer != 1.0);
  }
  record("error", error);
  EXPECT_LT(error, 1e-10);
}

// A rigid deck that a train brakes on: a mass on a spring and on a spring that slides, by steps of 1 microsecond.
TEST(SlidingBearings, InTimeAgainstAMassThatRubs) {
  const TemporaryFolder folder;
  constexpr double car = 2e4 + 2e3, deceleration = 8.0, soft = 4e6, stiff = 2e7, friction = 8e4;
  Results run = run_yaml(deck + quarter_car_with(2e4, 2e3, 2e6, 4e4, "law: linear, stiffness: 1.0e9") +
                             "train: {vehicles: car, positions: 5.0}\nts: {dt: 1.0e-4, max_time: 1.5}\n",
                         {{"train_speed_file", folder.write("speed.csv", "0,10\n0.2,10\n1.2,2\n")},
                          {"beam_EA", "1e15"},
                          {"foundation_longitudinal_k", "4e6,2e7"},
                          {"foundation_longitudinal_limit", "0,8e4"},
                          {"output_interval", "0.01"}});
  constexpr int steps = 10000;  // a sample
  constexpr double h = 0.01 / steps, deck_mass = 5000.0 * length;
  double u = 0.0, w = 0.0, slid = 0.0;
  std::vector<double> own;
  for (int i = 0; i <= 150 * steps; ++i) {
    if (i % steps == 0) own.insert(own.end(), 2, u);
    const double push = i >= 20 * steps && i < 120 * steps ? car * deceleration : 0.0;
    slid = std::clamp(slid, u - friction / stiff, u + friction / stiff);
    w += h * (push - soft * u - stiff * (u - slid)) / deck_mass;
    u += h * w;
  }
  EXPECT_GT(std::abs(slid), 1e-3);
  const double error = relative_difference(run("/probes/axial_displacement"), own);
  record("error", error);
  record("energy_error", energy_error(run));
  EXPECT_LT(error, 1e-3);
  EXPECT_LT(energy_error(run), 1e-4);
}

}  // namespace traverse::test
