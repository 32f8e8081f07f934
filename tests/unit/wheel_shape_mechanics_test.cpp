// Wheels out of round: derivatives against differences, depth and place of a flat, where its ends meet the rail.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "traverse/track/wheel_shape.hpp"

namespace traverse::track {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double R = 0.46;  // m

TEST(WheelShape, DerivativesAgainstDifferences) {
  WheelShape shape;
  shape.flat_length = 0.06;
  shape.flat_angle = 1.0;
  shape.polygon_order = 9;
  shape.polygon_amplitude = 2e-4;
  shape.polygon_phase = 0.3;
  const double d = 1e-6;
  for (double angle : {-20.0, 0.0, 0.5, 0.94, 0.99, 1.0, 1.03, 1.06, 1.5, 1.01 + 6.0 * pi, -2.0 * pi + 0.96}) {
    const RadiusGain g = radius_gain(shape, R, angle);
    const RadiusGain right = radius_gain(shape, R, angle + d), left = radius_gain(shape, R, angle - d);
    EXPECT_NEAR(g.slope, (right.value - left.value) / (2.0 * d), 1e-9) << "angle " << angle;
    EXPECT_NEAR(g.curvature, (right.slope - left.slope) / (2.0 * d), 1e-6) << "angle " << angle;
  }
}

// Zhai and others: L^2/(16 R) in the middle, nothing at the ends; 60 mm on a wheel of 0.46 m are 0.489 mm.
TEST(WheelShape, Flat) {
  WheelShape shape;
  EXPECT_TRUE(shape.round());
  shape.flat_length = 0.06;
  shape.flat_angle = pi;
  EXPECT_FALSE(shape.round());
  EXPECT_NEAR(flat_depth(0.06, R), 0.489e-3, 5e-7);
  EXPECT_DOUBLE_EQ(radius_gain(shape, R, pi).value, -0.06 * 0.06 / (16.0 * R));
  EXPECT_DOUBLE_EQ(radius_gain(shape, R, -pi).value, -0.06 * 0.06 / (16.0 * R)) << "rolled to the left";
  EXPECT_NEAR(radius_gain(shape, R, 7.0 * pi).value, -0.06 * 0.06 / (16.0 * R), 1e-15) << "three turns on";
  const double half = 0.03 / R;
  for (double end : {pi - half, pi + half}) {
    EXPECT_NEAR(radius_gain(shape, R, end).value, 0.0, 1e-18);
    EXPECT_NEAR(radius_gain(shape, R, end).slope, 0.0, 1e-15);
  }
  EXPECT_EQ(radius_gain(shape, R, pi + 1.001 * half).value, 0.0);
  EXPECT_EQ(radius_gain(shape, R, 0.0).value, 0.0);
}

TEST(WheelShape, EndsOfTheFlatInTurn) {
  WheelShape shape;
  EXPECT_TRUE(flat_ends(shape, R, 100.0).empty());
  shape.flat_length = 0.05;
  shape.flat_angle = 0.02;  // its rear end is at a negative angle
  const double half = 0.025 / R;
  const std::vector<double> exact = {0.02 + half, 0.02 - half + 2.0 * pi, 0.02 + half + 2.0 * pi,
                                     0.02 - half + 4.0 * pi};
  const std::vector<double> ends = flat_ends(shape, R, 4.0 * pi);
  ASSERT_EQ(ends.size(), exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(ends[i], exact[i], 1e-13);
  for (double length : {0.01, 0.05, 0.1234})  // of any flat, two in every turn
    for (double angle : {-7.0, 0.5, pi, 30.0}) {
      shape.flat_length = length;
      shape.flat_angle = angle;
      EXPECT_EQ(flat_ends(shape, R, 2000.0 * pi).size(), 2000u);
    }
}

}  // namespace
}  // namespace traverse::track
