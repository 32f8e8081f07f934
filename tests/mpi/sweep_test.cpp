// A sweep's results do not depend on how many ranks share its runs: to the last bit.
#include <gtest/gtest.h>

#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

void expect_same_bits(const std::string& yaml, const Values& options, const std::vector<std::string>& names) {
  Results all = run_yaml(yaml, options, MPI_COMM_WORLD);
  Results one = run_yaml(yaml, options, MPI_COMM_SELF);
  for (const std::string& name : names) {
    EXPECT_EQ(all("/sweep/" + name), one("/sweep/" + name)) << name;
    for (const double value : all("/sweep/" + name)) EXPECT_TRUE(std::isfinite(value)) << name;
  }
}

const std::vector<std::string> names = {"speed",       "peak_deflection",  "peak_acceleration",
                                        "peak_moment", "peak_moment_time", "amplification"};
const char* const bridge = R"(
beam: {spans: [20.0, 25.0], EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 6}
support: {types: [pinned, roller, roller]}
output: {probes: [10.0, 31.0]}
)";

TEST(Ranks, SweepByModes) {
  expect_same_bits(bridge, {{"model_modes", "4"}, {"sweep_speed", "30,60,2"}, {"sweep_hslm_a", "1,5,9"}}, names);
}

// Each round's speeds follow from the peaks of those before.
TEST(Ranks, RefinedSweep) {
  std::vector<std::string> refined = names;
  refined.emplace_back("added");
  expect_same_bits(
      bridge, {{"model_modes", "4"}, {"sweep_speed", "30,60,6"}, {"sweep_hslm_a", "1,9"}, {"sweep_refine", "1e-3"}},
      refined);
}

TEST(Ranks, SweepIsJudged) {
  std::vector<std::string> judged = names;
  judged.emplace_back("judged");
  for (const char* model : {"4", "0"})
    expect_same_bits(std::string(bridge) + "beam_continuity: simply_supported\n",
                     {{"model_modes", model},
                      {"ts_dt", "2e-3"},
                      {"limits", source_folder() + "/tests/data/limits_of_forces.yml"},
                      {"sweep_speed", "40,60,10"},
                      {"sweep_hslm_a", "1,9"}},
                     judged);
}

TEST(Ranks, SweepByElements) {
  expect_same_bits(bridge, {{"ts_dt", "5e-3"}, {"sweep_speed", "40,60,5"}, {"sweep_hslm_a", "3,8"}}, names);
}

TEST(Ranks, SweepOfVehicles) {
  std::vector<std::string> with_wheels = names;
  with_wheels.emplace_back("least_wheel_force");
  expect_same_bits("options_file: " + source_folder() +
                       "/options/scenes/three_span_train.yml\n"
                       "train_vehicles: coach\nscene_tail: 0\n",
                   {{"ts_dt", "5e-3"}, {"ts_type", "bdf"}, {"sweep_speed", "60,80,5"}}, with_wheels);
}

// Every rank takes all steps of a single run of linear vehicles over modes.
TEST(Ranks, StepsTakenApart) {
  const std::string yaml = "options_file: " + source_folder() +
                           "/options/scenes/three_span_train.yml\n"
                           "train_vehicles: coach*2\nscene_tail: 0\n";
  const Values options = {{"ts_dt", "2e-3"}, {"model_modes", "8"}, {"model_vehicles", "linear"}};
  Results all = run_yaml(yaml, options, MPI_COMM_WORLD);
  Results one = run_yaml(yaml, options, MPI_COMM_SELF);
  for (const char* name : {"/probes/deflection", "/probes/acceleration", "/vehicles/1/wheel_2/normal_force",
                           "/vehicles/0/car/acceleration", "/energy/dissipated", "/energy/work"})
    EXPECT_LT(relative_difference(all(name), one(name)), 1e-12) << name;
}

}  // namespace
}  // namespace traverse::test
