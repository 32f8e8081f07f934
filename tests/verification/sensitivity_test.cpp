// Sensitivity analyses of studies: of a nearly static deflection, whose derivatives are known, and of designs.
#include <gtest/gtest.h>

#include <cmath>

#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

// f1 = 12.4 Hz and a crossing of 10 s: the deflection is that of the force at rest, F L^3 / 48 EI, within 1 %.
const std::string slow = R"(
beam: {spans: 20.0, EI: 1.0e10, mass: 1.0e3, damping_ratios: 0.05}
model: {modes: 3}
load: {forces: 1.0e5, speed: 2.0}
output: {probes: 10.0}
study:
  vary:
    beam_EI: {normal: [1.0e10, 1.0e9]}
    beam_mass: {uniform: [0.9e3, 1.1e3]}
)";

/// The row of peak_deflection, the first quantity, of a dataset with two factors.
std::vector<double> of_deflection(Results& study, const std::string& name) {
  const std::vector<double>& all = study("/sensitivity/" + name);
  return {all.at(0), all.at(1)};
}

TEST(Sensitivity, TheDeflectionIsInverselyProportionalToTheStiffness) {
  Results study = run_yaml(slow, {{"study_sensitivity", "local"}});
  EXPECT_EQ(study("/study/shape"), std::vector<double>{5});
  const std::vector<double> elasticity = of_deflection(study, "elasticity");
  EXPECT_NEAR(elasticity[0], -1.0, 2e-2);
  EXPECT_NEAR(elasticity[1], 0.0, 2e-2);
  const double deflection = study("/study/peak_deflection")[0];
  EXPECT_NEAR(deflection, 1e5 * 8000.0 / 48.0 / 1e10, 2e-2 * deflection);
  EXPECT_NEAR(of_deflection(study, "effect_of_deviation")[0], -0.1 * deflection, 2e-3 * deflection);
  EXPECT_LT(of_deflection(study, "derivative_error")[0], 1e-2 * std::abs(of_deflection(study, "derivative")[0]));
}

TEST(Sensitivity, TheStiffnessAloneDecidesTheStaticDeflection) {
  Results sobol = run_yaml(slow, {{"study_sensitivity", "sobol"}, {"study_draws", "32"}});
  EXPECT_EQ(sobol("/study/shape"), std::vector<double>{32 * 4});
  const std::vector<double> total = of_deflection(sobol, "total"), low = of_deflection(sobol, "total_low"),
                            high = of_deflection(sobol, "total_high");
  EXPECT_LT(low[0], 1.0);
  EXPECT_GT(high[0], 1.0);
  EXPECT_LT(total[1], 1e-2 * total[0]);
  Results morris = run_yaml(slow, {{"study_sensitivity", "morris"}, {"study_draws", "6"}});
  EXPECT_EQ(morris("/study/shape"), std::vector<double>{6 * 3});
  const std::vector<double> effect = of_deflection(morris, "effect_magnitude");
  EXPECT_GT(effect[0], 50.0 * effect[1]);
}

// Quantities are the greatest over all options that are not factors.
TEST(Sensitivity, OtherOptionsAreTheGreatestOverTheirValues) {
  const Values local = {{"study_sensitivity", "local"}, {"study_vary_load_speed", "2,30"}};
  Results both = run_yaml(slow, local), fast = run_yaml(slow, {{"study_sensitivity", "local"}, {"load_speed", "30"}});
  const std::vector<double> wanted = of_deflection(fast, "derivative"), found = of_deflection(both, "derivative");
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(found[i], wanted[i], 1e-9 * std::abs(wanted[i]));
}

}  // namespace
}  // namespace traverse::test
