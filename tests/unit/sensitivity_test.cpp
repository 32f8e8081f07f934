// Designs and estimators of sensitivity analyses against functions whose indices are known.
#include "results/sensitivity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/sampling_design.hpp"

namespace traverse {
namespace {

/// T. Ishigami, T. Homma (1990), a = 7, b = 0.1, of three factors uniform in (-pi, pi), here from the unit cube.
double ishigami(const double* u) {
  const auto x = [u](int i) { return std::numbers::pi * (2.0 * u[i] - 1.0); };
  const double s = std::sin(x(1));
  return std::sin(x(0)) + 7.0 * s * s + 0.1 * std::pow(x(2), 4.0) * std::sin(x(0));
}

// The indices by the closed form: A. Saltelli et al., Global sensitivity analysis (2008), 4.
TEST(Sensitivity, SobolIndicesOfIshigamisFunction) {
  const std::vector<double> points = base::saltelli_design(4096, 3, 1);
  ASSERT_EQ(points.size(), 4096U * base::saltelli_block(3) * 3U);
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); i += 3) values.push_back(ishigami(&points[i]));
  const std::vector<results::SobolIndices> found = results::sobol_indices(values, 3, 0.95, 1);
  const double first[] = {0.3139, 0.4424, 0.0}, total[] = {0.5576, 0.4424, 0.2437};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].first.value, first[i], 0.02) << i;
    EXPECT_NEAR(found[i].total.value, total[i], 0.02) << i;
    EXPECT_LT(found[i].first.low, found[i].first.value + 1e-12);
    EXPECT_GT(found[i].first.high, found[i].first.value - 1e-12);
    EXPECT_LT(found[i].total.high - found[i].total.low, 0.1);
  }
}

// A factor without effect has indices of zero, and a shift of the quantity changes nothing.
TEST(Sensitivity, AFactorWithoutEffect) {
  const std::vector<double> points = base::saltelli_design(1024, 2, 3);
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); i += 2) values.push_back(1e6 + points[i]);
  const std::vector<results::SobolIndices> found = results::sobol_indices(values, 2, 0.95, 1);
  EXPECT_NEAR(found[0].total.value, 1.0, 0.05);
  EXPECT_EQ(found[1].first.value, 0.0);
  EXPECT_EQ(found[1].total.value, 0.0);
}

TEST(Sensitivity, EveryTrajectoryChangesEachFactorOnce) {
  const std::size_t factors = 4, block = base::morris_block(factors);
  const std::vector<double> points = base::morris_design(10, factors, 7);
  ASSERT_EQ(points.size(), 10 * block * factors);
  for (std::size_t t = 0; t < 10; ++t) {
    std::vector<int> changed(factors, 0);
    for (std::size_t p = 1; p < block; ++p)
      for (std::size_t i = 0; i < factors; ++i) {
        const double change = points[(t * block + p) * factors + i] - points[(t * block + p - 1) * factors + i];
        if (change == 0.0) continue;
        EXPECT_NEAR(std::abs(change), base::morris_step, 1e-12);
        ++changed[i];
      }
    EXPECT_EQ(changed, std::vector<int>(factors, 1));
  }
  for (const double u : points) EXPECT_TRUE(u >= -1e-12 && u <= 1.0 + 1e-12) << u;
}

// The elementary effects of a sum of terms a_i u_i are a_i, without scatter.
TEST(Sensitivity, ElementaryEffectsOfALinearFunction) {
  const std::size_t factors = 3, block = base::morris_block(factors);
  const double a[] = {2.0, -5.0, 0.0};
  const std::vector<double> points = base::morris_design(8, factors, 1);
  std::vector<double> values;
  std::vector<int> step(8 * factors, 0);
  for (std::size_t i = 0; i < points.size(); i += factors)
    values.push_back(a[0] * points[i] + a[1] * points[i + 1] + a[2] * points[i + 2]);
  for (std::size_t t = 0; t < 8; ++t)
    for (std::size_t p = 1; p < block; ++p)
      for (std::size_t i = 0; i < factors; ++i) {
        const double change = points[(t * block + p) * factors + i] - points[(t * block + p - 1) * factors + i];
        if (change != 0.0) step[t * factors + i] = change > 0.0 ? static_cast<int>(p) : -static_cast<int>(p);
      }
  const std::vector<results::MorrisMeasures> found = results::morris_measures(values, step, factors, 0.95, 1);
  for (std::size_t i = 0; i < factors; ++i) {
    EXPECT_NEAR(found[i].mean, a[i], 1e-12);
    EXPECT_NEAR(found[i].magnitude.value, std::abs(a[i]), 1e-12);
    EXPECT_NEAR(found[i].deviation, 0.0, 1e-12);
  }
}

/// The values of f at the points of a central difference about x = 2 with the step 0.01.
template <class Function>
results::LocalDerivative derivative(Function f) {
  return results::local_derivatives({f(2.0), f(2.01), f(1.99)}, {0.01}).front();
}

TEST(Sensitivity, LocalDerivativesAndTheirErrors) {
  const results::LocalDerivative square = derivative([](double x) { return x * x; });
  EXPECT_NEAR(square.value, 4.0, 1e-11);
  EXPECT_NEAR(square.error, 0.01, 1e-11);                                                 // h f''/2
  const results::LocalDerivative cubic = derivative([](double x) { return x * x * x; });  // error h^2
  EXPECT_NEAR(cubic.value, 12.0 + 1e-4, 1e-9);
  EXPECT_NEAR(cubic.error, 0.06, 1e-9);
  const results::LocalDerivative kink = derivative([](double x) { return std::max(x, 2.0 + 3.0 * (x - 2.003)); });
  EXPECT_GT(kink.error, 0.1 * kink.value);
}

}  // namespace
}  // namespace traverse
