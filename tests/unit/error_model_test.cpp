// What halvings of a step tell of the error.
#include "error_control/error_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace traverse::error_control {
namespace {

/// The error found with steps h, of a method whose peak is off by c h^order.
ErrorModel found(double c, double order, double h) {
  const auto peak = [&](double step) { return c * std::pow(step, order); };
  const ErrorModel first = error_from(peak(4.0 * h) - peak(2.0 * h), 2.0 * h, {});
  return error_from(peak(2.0 * h) - peak(h), h, first);
}

class Orders : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(ErrorModel, Orders, testing::Values(1.0, 1.5, 2.0, 3.0, 4.0));

TEST_P(Orders, AreMeasuredWithTheError) {
  const double order = GetParam(), h = 1e-3, c = 5.0;
  const ErrorModel error = found(c, order, h);
  EXPECT_TRUE(error.known);
  EXPECT_NEAR(error.order, order, 1e-9);
  const double cautious = (std::exp2(order) - 1.0) / (std::exp2(std::min(order, 3.0)) - 1.0);
  EXPECT_NEAR(error.value, cautious * c * std::pow(h, order), 1e-9 * error.value);
  EXPECT_NEAR(error.at(2.0), error.value * std::pow(2.0, order), 1e-9 * error.value * 16.0);
  const double wanted = 3.0 * error.value;
  EXPECT_NEAR(error.at(error.allowed_ratio(wanted)), wanted, 1e-9 * wanted);
}

// Halving is never supposed to gain more than the third power.
TEST(ErrorModel, IsCautiousTowardsShorterSteps) {
  const ErrorModel error = found(5.0, 4.0, 1e-3);
  EXPECT_NEAR(error.at(0.5), error.value / 8.0, 1e-9 * error.value);
  EXPECT_NEAR(error.allowed_ratio(error.value / 8.0), 0.5, 1e-9);
}

// Without a second halving the order is a supposed one.
TEST(ErrorModel, FirstHalving) {
  const ErrorModel error = error_from(3e-3, 1e-3, {});
  EXPECT_FALSE(error.known);
  EXPECT_DOUBLE_EQ(error.value, 1e-3);
}

// Two runs that agree by chance do not make an error vanish.
TEST(ErrorModel, ChanceIsNotBelieved) {
  const ErrorModel first = error_from(1e-2, 2e-3, {}), second = error_from(1e-12, 1e-3, first);
  EXPECT_GT(second.value, 1e-2 / 32.0 / 16.0);
}

TEST(ErrorModel, WhatDoesNotSettleKeepsItsError) {
  const ErrorModel first = error_from(1e-2, 2e-3, {}), second = error_from(1.1e-2, 1e-3, first);
  EXPECT_LT(second.order, 0.0);
  EXPECT_DOUBLE_EQ(second.value, 1.1e-2);
}

}  // namespace
}  // namespace traverse::error_control
