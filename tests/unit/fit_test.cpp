// Parts of a fit: interpolation, estimates from a given Jacobian, distinct minima.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fit/estimates.hpp"
#include "fit/spline.hpp"
#include "support/message.hpp"

namespace traverse::fit {
namespace {

double spline_error(double interval) {
  std::vector<double> samples;
  for (double t = 0.0; t < 2.0 * std::numbers::pi + 0.5 * interval; t += interval) samples.push_back(std::sin(t));
  const Spline spline(samples, interval);
  double error = 0.0;
  for (double t = 0.0; t < 2.0 * std::numbers::pi; t += 0.01)
    error = std::max(error, std::abs(spline(t) - std::sin(t)));
  return error;
}

// A sine has no second derivative at 0 and 2 pi, as a natural spline has none at its ends.
TEST(Spline, HasOrderFour) {
  const double coarse = spline_error(2.0 * std::numbers::pi / 40), fine = spline_error(2.0 * std::numbers::pi / 80);
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.1);
  EXPECT_LT(coarse, std::pow(2.0 * std::numbers::pi / 40, 4) / 300.0);
}

TEST(Spline, HoldsItsEnds) {
  const std::vector<double> samples = {1.0, 3.0, 2.0};
  const Spline spline(samples, 0.5);
  EXPECT_EQ(spline(-1.0), 1.0);
  EXPECT_EQ(spline(0.5), 3.0);
  EXPECT_EQ(spline(7.0), 2.0);
}

/// A fit of two options to as many frequencies as there are residuals.
options::Fit two_options(std::size_t measurements) {
  options::Fit fit;
  fit.parameters = {{"beam_EI", "N m2", 0.0, 10.0, 5.0}, {"beam_mass", "kg/m", 0.0, 2.0, 1.0}};
  for (std::size_t i = 0; i < measurements; ++i) fit.frequencies.push_back({"f", static_cast<int>(i) + 1, 1.0, 1.0});
  return fit;
}

Minimum minimum(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals) {
  Minimum one;
  one.u = Eigen::Vector2d(0.5, 0.5);
  one.residuals = residuals;
  one.jacobian = jacobian;
  return one;
}

// y = a x + b at x = 0, 1, 2, 3 with standard deviation 1: var(a) = 1/5, var(b) = 14/20, cov = -6/20.
TEST(Estimates, OfAStraightLine) {
  const options::Fit fit = two_options(4);
  Eigen::MatrixXd jacobian(4, 2);
  jacobian << 0.0, 2.0, 10.0, 2.0, 20.0, 2.0, 30.0, 2.0;  // u of a from 0 to 10, of b from 0 to 2
  const Estimates found = estimates_of(minimum(jacobian, Eigen::Vector4d(1.0, -1.0, -1.0, 1.0)), Residuals(fit, {}));
  EXPECT_DOUBLE_EQ(found.of[0].value, 5.0);
  EXPECT_NEAR(found.of[0].standard_error, std::sqrt(1.0 / 5.0), 1e-12);
  EXPECT_NEAR(found.of[1].standard_error, std::sqrt(14.0 / 20.0), 1e-12);
  EXPECT_NEAR(found.correlation(0, 1), -6.0 / std::sqrt(4.0 * 14.0), 1e-12);
  EXPECT_NEAR(found.ratio, 2.0, 1e-12);  // sum of squares 4, two degrees of freedom
  EXPECT_TRUE(found.sentences.empty());
}

TEST(Estimates, NameWhatTheDataDoNotTell) {
  const options::Fit fit = two_options(3);
  Eigen::MatrixXd jacobian(3, 2);
  jacobian << 1.0, -2.0, 2.0, -4.0, 3.0, -6.0;
  const Estimates pair = estimates_of(minimum(jacobian, Eigen::Vector3d::Zero()), Residuals(fit, {}));
  EXPECT_TRUE(std::isinf(pair.of[0].standard_error) && std::isinf(pair.of[1].standard_error));
  ASSERT_EQ(pair.sentences.size(), 1U);
  EXPECT_PRED2(test::contains, pair.sentences[0], "cannot tell beam_EI and beam_mass apart");
  jacobian.col(1).setZero();
  const Estimates alone = estimates_of(minimum(jacobian, Eigen::Vector3d::Zero()), Residuals(fit, {}));
  EXPECT_TRUE(std::isfinite(alone.of[0].standard_error) && std::isinf(alone.of[1].standard_error));
  ASSERT_EQ(alone.sentences.size(), 1U);
  EXPECT_EQ(alone.sentences[0], "The data do not depend on beam_mass.");
}

TEST(Estimates, AtABoundHaveNoStandardError) {
  const options::Fit fit = two_options(3);
  Eigen::MatrixXd jacobian(3, 2);
  jacobian << 1.0, 0.0, 0.0, 1.0, 1.0, 1.0;
  Minimum one = minimum(jacobian, Eigen::Vector3d(0.0, 0.5, 0.0));
  one.u[1] = 0.0;
  const Estimates found = estimates_of(one, Residuals(fit, {}));
  EXPECT_TRUE(found.of[1].at_bound);
  EXPECT_TRUE(std::isnan(found.of[1].standard_error));
  EXPECT_TRUE(std::isfinite(found.of[0].standard_error));
  EXPECT_TRUE(test::any_contains(found.sentences, "beam_mass is at its lower bound"));
}

TEST(Minima, AreDistinctIfTheLinearisedResidualsDoNotExplainThem) {
  Eigen::MatrixXd jacobian(3, 2);
  jacobian << 1.0, -2.0, 2.0, -4.0, 3.0, -6.0;
  std::vector<Minimum> minima(4, minimum(jacobian, Eigen::Vector3d(1.0, 1.0, -1.0)));  // no slope
  minima[1].u = Eigen::Vector2d(0.7, 0.6);                                             // along the valley
  minima[2].u = Eigen::Vector2d(0.9, 0.1);
  minima[2].residuals *= 2.0;
  minima[3].u = Eigen::Vector2d(0.1, 0.9);
  minima[3].residuals = Eigen::Vector3d(3.0, 3.0, 3.0);  // has not converged
  const std::vector<DistinctMinimum> found = distinct_minima(minima);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].count, 2);
  EXPECT_EQ(found[1].count, 1);
  EXPECT_NEAR(found[1].best->misfit(), 6.0, 1e-12);
}

}  // namespace
}  // namespace traverse::fit
