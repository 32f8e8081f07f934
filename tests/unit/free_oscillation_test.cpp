// A free oscillation against its differential equation, slow, fast and creeping.
#include <gtest/gtest.h>

#include "integrate/oscillation.hpp"

namespace traverse::test {
namespace {

TEST(FreeOscillation, ObeysItsEquation) {
  const double omega = 10.0, u0 = 0.3, v0 = -2.0, t = 0.13, h = 1e-4;
  for (const double sigma : {0.0, 0.5, 15.0}) {
    const auto displacement = [&](double time) {
      const integrate::FreeOscillation a = integrate::free_oscillation(omega, sigma, time);
      return a.uu * u0 + a.uw * v0;
    };
    const auto velocity = [&](double time) {
      const integrate::FreeOscillation a = integrate::free_oscillation(omega, sigma, time);
      return a.wu * u0 + a.ww * v0;
    };
    EXPECT_NEAR(displacement(0.0), u0, 1e-15);
    EXPECT_NEAR(velocity(0.0), v0, 1e-14);
    const double rate = (displacement(t + h) - displacement(t - h)) / (2.0 * h),
                 acceleration = (velocity(t + h) - velocity(t - h)) / (2.0 * h);
    EXPECT_NEAR(velocity(t), rate, 1e-5);
    EXPECT_NEAR(acceleration + 2.0 * sigma * velocity(t) + omega * omega * displacement(t), 0.0, 1e-3);
  }
}

}  // namespace
}  // namespace traverse::test
