// A study's results do not depend on how many ranks share its runs: to the last bit.
#include <gtest/gtest.h>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

void expect_same_study(const std::string& yaml, const Values& options, const std::vector<std::string>& names) {
  Results all = run_yaml(yaml, options, MPI_COMM_WORLD);
  Results one = run_yaml(yaml, options, MPI_COMM_SELF);
  for (const std::string& name : names) {
    EXPECT_EQ(all("/study/" + name), one("/study/" + name)) << name;
    for (const double value : all("/study/" + name)) EXPECT_TRUE(std::isfinite(value)) << name;
  }
}

const std::vector<std::string> names = {"finished",    "peak_deflection",  "peak_acceleration",
                                        "peak_moment", "peak_moment_time", "statistics/peak_deflection_mean"};

TEST(Ranks, StudyByElements) {
  expect_same_study(
      "beam: {spans: [20.0, 25.0], EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 6}\n"
      "support: {types: [pinned, roller, roller]}\n"
      "load: {hslm_a: 3, speed: 50.0}\n"
      "ts_dt: 5.0e-3\n"
      "study: {vary: {beam_mass: {normal: [1.0e4, 5.0e2]}, load_speed: [40, 50]}, draws: 5}\n",
      {}, names);
}

// Each round's speeds follow from the peaks of those before.
TEST(Ranks, RefinedStudy) {
  std::vector<std::string> with_speeds(names.begin(), names.end() - 1);
  with_speeds.emplace_back("load_speed");
  expect_same_study(
      "beam: {spans: [20.0, 25.0], EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 6}\n"
      "support: {types: [pinned, roller, roller]}\n"
      "load: {hslm_a: 3, speed: 50.0}\n"
      "model: {modes: 4}\n"
      "study: {vary: {beam_mass: [1.0e4, 1.1e4], load_speed: [40, 50, 60, 70]}, refine: 1.0e-3}\n",
      {}, with_speeds);
}

TEST(Ranks, StudyOfTracks) {
  std::vector<std::string> with_wheels = names;
  with_wheels.emplace_back("least_wheel_force");
  expect_same_study("options_file: " + source_folder() +
                        "/options/scenes/three_span_train.yml\n"
                        "train_vehicles: coach\nscene_tail: 0\ntrack_profile: german_low\n",
                    {{"ts_dt", "7e-4"},
                     {"model_modes", "6"},
                     {"model_vehicles", "linear"},
                     {"study_vary_track_seed", "1:20"},
                     {"study_vary_train_speed", "70,80"}},
                    with_wheels);
}

// More trains than a rank keeps.
TEST(Ranks, StudyOfTrains) {
  expect_same_study("options_file: " + source_folder() +
                        "/options/scenes/three_span_train.yml\n"
                        "train_vehicles: coach\nscene_tail: 0\nbeam_elements_per_span: 8\n",
                    {{"ts_dt", "2e-3"},
                     {"model_modes", "6"},
                     {"model_vehicles", "linear"},
                     {"study_vary_vehicle_coach_car_mass_normal", "47800,2000"},
                     {"study_vary_train_speed", "70,80"},
                     {"study_draws", "40"}},
                    names);
}

}  // namespace
}  // namespace traverse::test
