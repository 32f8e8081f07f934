// How much of its force a wheel loses after a low-pass, and how long.
#include "run/wheel_unloading.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace traverse::run {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

// Two wheels of 100 and 50 kN: the first loses 0.7 at 2 Hz and shakes at 90 Hz, the second loses 0.4 at 3 Hz.
TEST(WheelUnloading, OfLowPassedForces) {
  Plan plan;
  plan.end_time = 4.0;
  plan.interval = 2.5e-3;
  FilteredWheels wheels(20.0, 0.6, plan, 2);
  for (int k = 0; k <= 1600; ++k) {
    const double t = 2.5e-3 * k, fade = std::min(1.0, t);
    const double first = 1e5 * (1.0 - fade * (0.7 * std::sin(two_pi * 2.0 * t) + 0.5 * std::sin(two_pi * 90.0 * t)));
    const double second = 5e4 * (1.0 - fade * 0.4 * std::sin(two_pi * 3.0 * t));
    EXPECT_FALSE(wheels.is_due(t + 1e-3)) << "between two instants";
    ASSERT_TRUE(wheels.is_due(t));
    wheels.add(first);
    wheels.add(second);
    EXPECT_FALSE(wheels.is_due(t)) << "a second time";
  }
  const results::FilteredUnloading found = wheels.finish(train::Fleet());
  EXPECT_NEAR(found.extreme.value, 0.7, 1e-3);
  // A sine stays above 0.6 of 0.7 for (pi - 2 asin(6/7)) of two pi.
  EXPECT_NEAR(found.longest, (std::numbers::pi - 2.0 * std::asin(6.0 / 7.0)) / (two_pi * 2.0), 5e-4);
  EXPECT_EQ(found.frequency, 20.0);
  EXPECT_EQ(found.level, 0.6);
}

TEST(WheelUnloading, NeverAboveTheLevel) {
  Plan plan;
  plan.end_time = 1.0;
  plan.interval = 2.5e-3;
  FilteredWheels wheels(20.0, 0.6, plan, 1);
  for (int k = 0; k <= 400; ++k) wheels.add(1e5 * (1.0 - 0.3 * std::sin(two_pi * 2.0 * 2.5e-3 * k)));
  const results::FilteredUnloading found = wheels.finish(train::Fleet());
  EXPECT_NEAR(found.extreme.value, 0.3, 1e-3);
  EXPECT_EQ(found.longest, 0.0);
}

}  // namespace
}  // namespace traverse::run
