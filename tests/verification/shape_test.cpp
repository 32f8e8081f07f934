// Stored shapes are the elements' own curves: exact between the nodes too, however few there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

constexpr double L = 20.0, EI = 1e10, P = 2e5, a = 12.0, b = L - a, q = 1e4 * 9.81;
const std::string span = "beam: {spans: 20.0, EI: 1.0e10, mass: 1.0e4}\nsupport: {types: [pinned, roller]}\n";

double by_force(double x) {
  return x <= a ? P * b * x * (L * L - b * b - x * x) / (6.0 * L * EI)
                : P * a * (L - x) * (L * L - a * a - (L - x) * (L - x)) / (6.0 * L * EI);
}
double by_weight(double x) { return q * x * (L * L * L - 2.0 * L * x * x + x * x * x) / (24.0 * EI); }

TEST(Shape, OfStaticsIsExactBetweenTheNodes) {
  for (const char* elements : {"1", "2", "3"}) {
    Results run = run_yaml(span, {{"beam_elements_per_span", elements},
                                  {"load_forces", "2e5"},
                                  {"load_positions", "12"},
                                  {"beam_self_weight", "true"},
                                  {"output_probes", "7.3,10"},
                                  {"scene_analysis", "static"}});
    const std::vector<double>&x = run("/shape/x"), &v = run("/shape/deflection");
    ASSERT_EQ(x.size(), v.size());
    ASSERT_GE(x.size(), 200u);
    const double deepest = by_force(10.0) + by_weight(10.0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(-v[i], by_force(x[i]) + by_weight(x[i]), 1e-8 * deepest) << x[i];
    }
    EXPECT_TRUE(std::is_sorted(x.begin(), x.end()));
    for (const double place : {7.3, 10.0}) {
      const auto at = std::find_if(x.begin(), x.end(), [&](double y) { return std::abs(y - place) < 1e-9; });
      ASSERT_NE(at, x.end()) << "a probe is a point of the shape";
    }
    EXPECT_NEAR(*std::min_element(v.begin(), v.end()), run.attribute("/summary", "deflection"), 2e-3 * deepest);
  }
}

TEST(Shape, AtTheWorstInstantShowsThePeak) {
  for (const char* modes : {"0", "4"}) {
    Results run = run_yaml(span, {{"beam_elements_per_span", "2"},
                                  {"load_forces", "2e5,2e5"},
                                  {"load_positions", "0,-6"},
                                  {"load_speed", "40"},
                                  {"output_probes", "9"},
                                  {"model_modes", modes},
                                  {modes[0] == '0' ? "ts_dt" : "output_interval", "1e-3"}});
    const std::vector<double>&x = run("/shape/x"), &v = run("/shape/deflection");
    const auto at = std::find_if(x.begin(), x.end(), [](double y) { return std::abs(y - 9.0) < 1e-9; });
    ASSERT_NE(at, x.end());
    const double there = v[static_cast<std::size_t>(at - x.begin())];
    EXPECT_NEAR(there, run.attribute("/summary", "deflection"), 1e-4 * std::abs(there));
  }
}

// A parabola by one element, sines by more; every mode has its largest ordinate, 1, wherever that is.
TEST(Shape, OfModesBetweenTheNodes) {
  Results one = run_yaml(span, {{"beam_elements_per_span", "1"}, {"scene_analysis", "modes"}, {"modes_count", "1"}});
  const std::vector<double>& x = one("/modes/x");
  ASSERT_GE(x.size(), 200u);
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_NEAR(std::abs(one("/modes/shape")[i]), 4.0 * x[i] * (L - x[i]) / (L * L), 1e-6);
  // The second sine: cubic curves are off by the fourth power of the element, straight lines by the second.
  std::vector<double> errors;
  for (const char* elements : {"6", "12"}) {
    Results run =
        run_yaml(span, {{"beam_elements_per_span", elements}, {"scene_analysis", "modes"}, {"modes_count", "2"}});
    const std::vector<double>&y = run("/modes/x"), &shape = run("/modes/shape");
    ASSERT_EQ(shape.size(), 2 * y.size());
    errors.push_back(0.0);
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double sine = std::abs(std::sin(2.0 * std::numbers::pi * y[i] / L));
      errors.back() = std::max(errors.back(), std::abs(std::abs(shape[y.size() + i]) - sine));
    }
  }
  EXPECT_LT(errors[0], 5e-3);
  EXPECT_LT(errors[1], errors[0] / 12.0);
}

}  // namespace
}  // namespace traverse::test
