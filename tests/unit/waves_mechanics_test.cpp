// Sums of waves from their table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "traverse/track/waves.hpp"

namespace traverse::track {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi, shortest = 0.3;

/// Waves of 100 m to 0.3 m, all as steep as each other.
Waves some_waves() {
  std::vector<double> amplitude, frequency, phase;
  for (int i = 0; i < 40; ++i) {
    frequency.push_back(0.01 * std::pow(100.0 / shortest, i / 39.0));
    amplitude.push_back(1e-4 / frequency.back());
    phase.push_back(0.37 * i);
  }
  return {amplitude, frequency, phase};
}

TEST(Waves, TableAgainstTheSum) {
  const Waves waves = some_waves();
  const double height = 1e-4 * shortest, k = two_pi / shortest;
  double value = 0.0, slope = 0.0, curvature = 0.0;
  for (int i = -200; i < 5000; ++i) {
    const Height is = waves.at(0.01234 * i), exact = waves.sum(0.01234 * i);
    value = std::max(value, std::abs(is.value - exact.value));
    slope = std::max(slope, std::abs(is.slope - exact.slope));
    curvature = std::max(curvature, std::abs(is.curvature - exact.curvature));
  }
  RecordProperty("value", std::to_string(1e12 * value / height) + "e-12");
  RecordProperty("slope", std::to_string(1e12 * slope / (height * k)) + "e-12");
  RecordProperty("curvature", std::to_string(1e12 * curvature / (height * k * k)) + "e-12");
  EXPECT_LT(value, 1e-11 * height);
  EXPECT_LT(slope, 2e-9 * height * k);
  EXPECT_LT(curvature, 1e-7 * height * k * k);
}

TEST(Waves, PlacesInARowAgainstTheSum) {
  const Waves waves = some_waves();
  const double height = 1e-4 * shortest, k = two_pi / shortest;
  const std::vector<Height> row = waves.sums(-3.0, 0.01234, 5000);
  ASSERT_EQ(row.size(), 5000U);
  for (int i = 0; i < 5000; ++i) {
    const Height exact = waves.sum(-3.0 + 0.01234 * i), &is = row[static_cast<std::size_t>(i)];
    EXPECT_NEAR(is.value, exact.value, 1e-11 * height) << i;
    EXPECT_NEAR(is.slope, exact.slope, 1e-11 * height * k) << i;
    EXPECT_NEAR(is.curvature, exact.curvature, 1e-11 * height * k * k) << i;
  }
}

// What was asked before, however far away, changes nothing.
TEST(Waves, DoNotDependOnWhatWasAsked) {
  const Waves one = some_waves(), other = some_waves();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(0.0, 500.0);
  for (int i = 0; i < 2000; ++i) {
    const double s = anywhere(random);
    other.at(anywhere(random));
    const Height a = one.at(s), b = other.at(s), again = one.at(s);
    EXPECT_EQ(a.value, b.value);
    EXPECT_EQ(a.curvature, b.curvature);
    EXPECT_EQ(a.slope, again.slope);
  }
}

}  // namespace
}  // namespace traverse::track
