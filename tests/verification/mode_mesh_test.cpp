// Natural modes with the mesh left open: every frequency that is asked for is right to `accuracy`, and the error said
// is no smaller than it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

// Of a simple span: bending n^2 pi^2/L^2 sqrt(EI/m), and along x (2 n - 1) pi/(2 L) sqrt(EA/m), which elements of first
// order follow slowly.
TEST(ModeMesh, FrequenciesKeepTheAccuracy) {
  constexpr double L = 20.0, EI = 2.0e9, EA = 1.0e10, m = 1.0e4;
  std::vector<double> exact;
  for (int n = 1; n <= 12; ++n) {
    exact.push_back(0.5 * pi * n * n / (L * L) * std::sqrt(EI / m));
    exact.push_back((2 * n - 1) / (4.0 * L) * std::sqrt(EA / m));
  }
  std::sort(exact.begin(), exact.end());
  for (const double accuracy : {1e-3, 1e-4}) {
    Results run = run_yaml(
        "scene: {analysis: modes}\nbeam: {spans: 20.0, EI: 2.0e9, EA: 1.0e10, mass: 1.0e4}\n"
        "support: {types: [pinned, roller]}\n",
        {{"modes_count", "10"}, {"accuracy", text(accuracy)}});
    const std::vector<double>& found = run("/modes/frequency");
    ASSERT_EQ(found.size(), 10u);
    double worst = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(found[i] / exact[i] - 1.0));
    const double said = run.attribute("/summary", "expected_error_frequency");
    EXPECT_LT(worst, accuracy);
    EXPECT_LE(said, accuracy);
    EXPECT_GT(said, 0.8 * worst);
  }
}

}  // namespace
}  // namespace traverse::test
