// Statics of one span of very many elements: rounding takes 0.02 eps n^4 of a plain solution. What is left after
// refinement is estimated, and the estimate has to be honest; where nothing is left the program says so.
#include <gtest/gtest.h>

#include <cmath>

#include "support/curve.hpp"
#include "support/scene_run.hpp"
#include "traverse/base/error.hpp"

namespace traverse::test {
namespace {

Results under_a_force(int elements) {
  return run_yaml(R"(
beam: {spans: 100.0, EI: 1.96e9, mass: 1000.0}
load: {forces: 1.0e5, positions: 50.0, speed: 0.0}
scene: {analysis: static}
)",
                  {{"beam_elements_per_span", std::to_string(elements)}});
}

TEST(LongChain, StaticErrorIsEstimatedHonestly) {
  const double exact = -1e5 * 1e6 / (48 * 1.96e9);
  for (const int n : {10, 1000, 10000, 50000}) {
    Results run = under_a_force(n);
    const double error = std::abs(run("/probes/deflection")[0] / exact - 1.0);
    const double estimate = run.attribute("/summary", "static_error");
    RecordProperty("error_" + std::to_string(n), text(error));
    EXPECT_LT(error, 1e-8) << n;
    EXPECT_LT(error, 10.0 * estimate + 1e-14) << n;
    EXPECT_LT(estimate, 1e-8) << n;
  }
}

TEST(LongChain, WhereNoDigitIsLeftItIsRefused) { EXPECT_THROW(under_a_force(100000), SolverError); }

}  // namespace
}  // namespace traverse::test
