// Functions of time that are straight lines, splines or piecewise linear tables: values, derivatives, sides of kinks,
// order of convergence and refused tables; splines and Gauss' rules.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "base/gauss.hpp"
#include "base/spline.hpp"
#include "traverse/base/error.hpp"
#include "traverse/base/time_function.hpp"

namespace traverse::base {
namespace {

TEST(TimeFunction, StraightLine) {
  TimeFunction f(2.0, 3.0);
  EXPECT_EQ(f.value(1.5), 6.5);
  EXPECT_EQ(f.rate(1.5), 3.0);
  EXPECT_EQ(f.acceleration(1.5), 0.0);
  f.shift(1.0);
  EXPECT_EQ(f.value(0.0), 3.0);
  EXPECT_EQ(TimeFunction().value(7.0), 0.0);
}

TEST(TimeFunction, SplinePassesThroughItsTableAndIsTwiceSmooth) {
  const std::vector<double> t = {0.0, 0.7, 1.4, 2.5, 3.0}, y = {1.0, -1.0, 0.5, 2.0, 0.0};
  const TimeFunction f(t, y);
  for (std::size_t i = 0; i < t.size(); ++i) EXPECT_NEAR(f.value(t[i]), y[i], 1e-15);
  for (const double at : {0.7, 1.4, 2.5}) {
    const double h = 1e-9;
    EXPECT_NEAR(f.value(at - h), f.value(at + h), 1e-7);
    EXPECT_NEAR(f.rate(at - h), f.rate(at + h), 1e-6);
    EXPECT_NEAR(f.acceleration(at - h), f.acceleration(at + h), 1e-5);
  }
  EXPECT_NEAR(f.acceleration(0.0), 0.0, 1e-14);  // natural ends
  EXPECT_NEAR(f.acceleration(std::nextafter(3.0, 0.0)), 0.0, 1e-13);
  for (const double at : {-0.5, 0.1, 0.9, 2.0, 2.9, 4.0}) {  // outside too
    const double h = 1e-4;
    EXPECT_NEAR(f.rate(at), (f.value(at + h) - f.value(at - h)) / (2.0 * h), 1e-6);
    EXPECT_NEAR(f.acceleration(at), (f.rate(at + h) - f.rate(at - h)) / (2.0 * h), 1e-6);
  }
}

TEST(TimeFunction, SplineOfAStraightLineIsTheLine) {
  const TimeFunction f({0.0, 1.0, 4.0}, {2.0, 5.0, 14.0});
  for (const double t : {0.0, 0.3, 2.0, 3.9}) {
    EXPECT_NEAR(f.value(t), 2.0 + 3.0 * t, 1e-13);
    EXPECT_NEAR(f.rate(t), 3.0, 1e-14);
    EXPECT_NEAR(f.acceleration(t), 0.0, 1e-14);
  }
}

TEST(TimeFunction, HoldsItsEndValuesOutsideTheTable) {
  TimeFunction f({1.0, 3.0}, {0.0, 4.0});
  EXPECT_DOUBLE_EQ(f.value(2.0), 2.0);
  EXPECT_DOUBLE_EQ(f.rate(2.0), 2.0);
  EXPECT_EQ(f.kinks(), (std::vector<double>{1.0, 3.0}));
  EXPECT_DOUBLE_EQ(f.jump_of_rate(0), 2.0);
  EXPECT_DOUBLE_EQ(f.jump_of_rate(1), -2.0);
  f.shift(5.0);
  f.delay(1.0);
  EXPECT_EQ(f.value(-7.0), 5.0);
  EXPECT_EQ(f.value(40.0), 9.0);
  EXPECT_EQ(f.rate(40.0), 0.0);
  EXPECT_EQ(f.kinks(), (std::vector<double>{2.0, 4.0}));
}

// Equal rows at an end say that the table comes to rest there.
TEST(TimeFunction, RestsAtEndsWithEqualRows) {
  const TimeFunction f({0.0, 1.0, 2.0, 3.0}, {0.0, 0.0, 1.0, 1.0});
  for (const std::size_t end : {0U, 3U}) EXPECT_EQ(f.jump_of_rate(end), 0.0);
  for (const double t : {0.0, 1.0, 2.0, 3.0}) EXPECT_NEAR(f.rate(t - 1e-9), f.rate(t + 1e-9), 1e-7);
  EXPECT_NEAR(f.value(1.5), 0.5, 1e-15);
  EXPECT_EQ(f.value(4.0), 1.0);
}

// At a kink, the step that ends there has the rate before it, and the next step the rate after it.
TEST(TimeFunction, AStepHasOneSideOfAKink) {
  TimeFunction f({0.0, 1.0, 2.0}, {0.0, 0.5, 2.0});
  f.select_side(1.9);
  EXPECT_GT(f.rate(2.0), 1.0);
  EXPECT_NEAR(f.value(1.0), 0.5, 1e-15);  // also across a row inside
  EXPECT_TRUE(f.select_side(2.1));
  EXPECT_EQ(f.rate(2.0), 0.0);
  EXPECT_FALSE(f.select_side(2.2));
}

// A natural spline through rows at uneven times may swing far beyond them.
TEST(TimeFunction, RefusesASplineFarOutsideItsRows) {
  try {
    const TimeFunction f({0.0, 1.0, 1.001, 2.0}, {0.0, 0.0, 0.01, 0.01});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("reaches -1.48 at 0.6667 s"), std::string::npos) << error.what();
  }
}

TEST(TimeFunction, SplineConvergesToASineAtFourthOrder) {
  // over a full half wave the natural end conditions are exact
  const auto error = [](int n) {
    std::vector<double> t, y;
    for (int i = 0; i <= n; ++i) {
      t.push_back(std::numbers::pi * i / n);
      y.push_back(std::sin(t.back()));
    }
    const TimeFunction f(t, y);
    double largest = 0.0;
    for (int i = 0; i < 1000; ++i) largest = std::max(largest, std::abs(f.value(i * 3e-3) - std::sin(i * 3e-3)));
    return largest;
  };
  EXPECT_GT(std::log2(error(8) / error(16)), 3.9);
}

// A cubic is its own spline between its end slopes; the natural spline through (0, 0), (1, 1), (3, 0) has the second
// derivative -3/2 in the middle, since 2 (1 + 2) y'' = 6 (-1/2 - 1).
TEST(Spline, HasTheClosedFormOfSmallTables) {
  const std::vector<double> x = {-1.0, 0.5, 0.7, 2.0, 2.1};
  std::vector<double> y;
  for (const double at : x) y.push_back(at * at * at - at);
  const std::vector<double> slopes = spline_slopes(x, y, {2.0, 3.0 * 2.1 * 2.1 - 1.0});
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(slopes[i], 3.0 * x[i] * x[i] - 1.0, 1e-13);
  const std::vector<double> three = {0.0, 1.0, 3.0}, values = {0.0, 1.0, 0.0};
  EXPECT_NEAR(spline_curvatures(three, values)[1], -1.5, 1e-15);
  EXPECT_NEAR(spline_slopes(three, values)[0], 1.25, 1e-15);  // 1 + 1.5/6
  EXPECT_NEAR(spline_slopes(three, values)[2], -1.0, 1e-15);  // -1/2 - 2*1.5/6
}

// A rule of N points integrates x^(2N - 1) + x^(2N - 2) over [1, 2] exactly.
template <std::size_t N>
void expect_exact_rule() {
  double sum = 0.0;
  at_gauss_points<N>(1.0, 2.0,
                     [&](double x, double weight) { sum += weight * (1.0 + x) * std::pow(x, 2.0 * N - 2.0); });
  const double exact =
      (std::pow(2.0, 2.0 * N) - 1.0) / (2.0 * N) + (std::pow(2.0, 2.0 * N - 1.0) - 1.0) / (2.0 * N - 1.0);
  EXPECT_NEAR(sum / exact, 1.0, 4e-16) << N << " points";
}

TEST(GaussRule, IsExactForItsDegree) {
  expect_exact_rule<3>();
  expect_exact_rule<4>();
  expect_exact_rule<5>();
}

TEST(TimeFunction, RefusesBadTables) {
  const std::vector<double> one = {1.0};
  EXPECT_THROW(TimeFunction(one, one), InputError);
  EXPECT_THROW(TimeFunction({0.0, 1.0}, one), InputError);
  EXPECT_THROW(TimeFunction({0.0, 0.0}, {1.0, 2.0}), InputError);
  EXPECT_THROW(TimeFunction({0.0, 1.0, 0.5}, {1.0, 2.0, 3.0}), InputError);
  EXPECT_THROW(TimeFunction({0.0, 1.0}, {1.0, std::numeric_limits<double>::infinity()}), InputError);
}

TEST(TimeFunction, ForcesGoStraightAndHoldTheirEndValues) {
  const auto f = TimeFunction::piecewise_linear({0.4, 1.0, 100.0}, {0.0, 8000.0, 8000.0});
  EXPECT_EQ(f.value(0.0), 0.0);
  EXPECT_NEAR(f.value(0.7), 4000.0, 1e-9);
  EXPECT_EQ(f.value(50.0), 8000.0);  // a spline would swing beyond
  EXPECT_EQ(f.value(200.0), 8000.0);
  EXPECT_EQ(f.rate(0.0), 0.0);
  EXPECT_NEAR(f.rate(0.5), 8000.0 / 0.6, 1e-9);
  EXPECT_EQ(f.acceleration(0.5), 0.0);
  EXPECT_EQ(f.kinks(), (std::vector<double>{0.4, 1.0, 100.0}));
}

}  // namespace
}  // namespace traverse::base
