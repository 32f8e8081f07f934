// Every file in options/: it loads, scenes run to their end, and each opens with what, source and expected figure.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "support/folders.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/options/" + folder)) {
    if (entry.path().extension() == ".yml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string stem(const testing::TestParamInfo<std::string>& info) {
  return std::filesystem::path(info.param).stem().string();
}

void expect_three_lines(const std::string& file) {
  std::ifstream in(file);
  for (const std::string first : {"# What: ", "# Source: ", "# Expected: "}) {
    std::string line;
    std::getline(in, line);
    EXPECT_TRUE(line.starts_with(first)) << line;
    EXPECT_GT(line.size(), first.size() + 10) << line;
  }
}

/// Long scenes are cut short.
class SceneFile : public testing::TestWithParam<std::string> {};
TEST_P(SceneFile, RunsToItsEnd) {
  expect_three_lines(GetParam());
  const Workplace workplace("");
  const Outcome outcome = workplace.run({"-options_file", GetParam(), "-ts_max_time", "0.2", "-output_file", "r.h5"});
  expect_success(outcome);
  Results results(workplace.path("r.h5"));
  if (outcome.out.find("largest static effects") != std::string::npos) {
    EXPECT_GT(results("/static/moment").size(), 0u);
    return;
  }
  if (outcome.out.find("UIC 774-3") != std::string::npos) {
    EXPECT_GT(results("/rail_forces/in_sequence/greatest_stress").size(), 0u);
    return;
  }
  if (outcome.out.find("decided by the bound") != std::string::npos) {
    EXPECT_GT(results("/screen/ratio").size(), 0u);
    return;
  }
  EXPECT_NE(outcome.out.find("reached its end"), std::string::npos) << outcome.out;
  const bool sweep = outcome.out.find("  the sweep ") != std::string::npos;
  if (sweep) {
    EXPECT_GT(results("/sweep/peak_deflection").size(), 0u);
  } else {
    EXPECT_NEAR(results.attribute("/summary", "end_time"), 0.2, 1e-12);
    EXPECT_GT(results.time().back(), 0.2 - results.attribute("/time", "interval"));
  }
}
INSTANTIATE_TEST_SUITE_P(Options, SceneFile, testing::ValuesIn(files_in("scenes")), stem);

/// What makes a study of many runs one of few.
std::vector<std::string> fewer_runs(const std::string& study) {
  if (study == "thousand_tracks")
    return {"-study_vary_track_seed", "1:3", "-train_vehicles", "coach", "-accuracy", "3e-2"};
  if (study == "twenty_tracks")
    return {"-study_vary_track_seed",
            "1:2",
            "-study_vary_train_speed_step",
            "80 km/h",
            "-train_vehicles",
            "coach",
            "-accuracy",
            "3e-2"};
  if (study == "truck_class_c") return {"-study_vary_track_seed", "1:2", "-study_vary_train_speed_step", "80 km/h"};
  if (study == "bearing_stiffness") return {"-study_vary_load_speed_step", "70"};
  if (study == "en1991_bridge" || study == "hslm_envelope")
    return {"-sweep_speed", "50,80,15", "-sweep_hslm_a", "1,10"};
  if (study == "least_stiffness") return {"-sweep_speed", "70,84,7", "-sweep_hslm_a", "9,10", "-find_points", "5"};
  if (study == "permitted_speeds") return {"-sweep_hslm_a", "9,10", "-find_points", "17"};
  if (study == "sensitivity") return {"-study_draws", "4"};
  return {};
}

/// Every study with few runs.
class StudyFile : public testing::TestWithParam<std::string> {};
TEST_P(StudyFile, RunsToItsEnd) {
  expect_three_lines(GetParam());
  const Workplace workplace("");
  std::vector<std::string> words = {"-options_file", GetParam(), "-output_file", "r.h5"};
  for (const std::string& word : fewer_runs(stem({GetParam(), 0}))) words.push_back(word);
  const Outcome outcome = workplace.run(words);
  expect_success(outcome);
  EXPECT_NE(outcome.out.find("reached its end"), std::string::npos) << outcome.out;
  Results results(workplace.path("r.h5"));
  if (outcome.out.find("  the sweep ") != std::string::npos) {
    for (const double peak : results("/sweep/peak_deflection")) EXPECT_GE(peak, 0.0);
    return;
  }
  if (outcome.out.find("; the fit ") != std::string::npos) {
    for (const double error : results("/fit/standard_error")) EXPECT_GT(error, 0.0);
    return;
  }
  for (const double done : results("/study/finished")) EXPECT_EQ(done, 1.0);
  if (outcome.out.find("statistics over") != std::string::npos) {
    EXPECT_GT(results("/study/statistics/peak_deflection_mean").size(), 0u);
  }
}
INSTANTIATE_TEST_SUITE_P(Options, StudyFile, testing::ValuesIn(files_in("studies")), stem);

class BridgeFile : public testing::TestWithParam<std::string> {};
TEST_P(BridgeFile, CarriesAForce) {
  expect_three_lines(GetParam());
  const Workplace workplace("load: {forces: 1.0e5, speed: 50.0}\n");
  const Outcome outcome = workplace.run({"-options_file", GetParam(), "-ts_max_time", "0.02", "-ts_dt", "0.01",
                                         "-beam_elements_per_span", "2", "-output_file", "r.h5"});
  expect_success(outcome);
}
INSTANTIATE_TEST_SUITE_P(Options, BridgeFile, testing::ValuesIn(files_in("bridges")), stem);

/// Those with wheels; the others have scenes of their own.
std::vector<std::string> files_with_wheels() {
  std::vector<std::string> files = files_in("vehicles");
  std::erase_if(files, [](const std::string& file) {
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return text.find("\nwheels:") == std::string::npos;
  });
  return files;
}

/// On rigid ground, where its wheels carry its weight at rest.
class VehicleFile : public testing::TestWithParam<std::string> {};
TEST_P(VehicleFile, StandsAndRolls) {
  expect_three_lines(GetParam());
  const Workplace workplace("train: {vehicles: it, speed: 50.0}\n");
  const Outcome outcome =
      workplace.run({"-vehicle_it_file", GetParam(), "-ts_max_time", "0.02", "-ts_dt", "0.01", "-output_file", "r.h5"});
  expect_success(outcome);
  EXPECT_NE(outcome.out.find("contact losses        none"), std::string::npos) << outcome.out;
}
INSTANTIATE_TEST_SUITE_P(Options, VehicleFile, testing::ValuesIn(files_with_wheels()), stem);

}  // namespace
}  // namespace traverse::test
