// Sweeps and studies that are judged by limits: every run by what it says of itself alone, all by the worst of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

const std::string limits = source_folder() + "/tests/data/limits_of_forces.yml";
const std::string decks = R"(
beam: {spans: [20.0, 20.0], EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 8}
beam_continuity: simply_supported
support: {types: [pinned, roller, roller]}
load: {forces: [1.0e5, 1.0e5], positions: [0.0, -9.0], speed: 40.0}
scene: {tail: 0.5}
output: {interval: 2.0e-3, probes: [10.0, 25.0]}
)";

/// Row `run` of what the runs found.
std::vector<double> row(Results& all, const std::string& name, std::size_t run, std::size_t count) {
  const std::vector<double>& values = all(name);
  const auto from = values.begin() + static_cast<std::ptrdiff_t>(run * count);
  return {from, from + static_cast<std::ptrdiff_t>(count)};
}

/// The verdicts are on the greatest value of each limit.
void expect_verdicts(Results& all, const std::string& name) {
  const std::vector<double> limit = all("/verdicts/limit"), worst = all("/verdicts/value");
  const std::vector<double>& found = all(name);
  for (std::size_t l = 0; l < limit.size(); ++l) {
    double greatest = 0.0, broken = 0.0;
    for (std::size_t i = l; i < found.size(); i += limit.size()) {
      greatest = std::max(greatest, found[i]);
      broken += found[i] > limit[l] ? 1.0 : 0.0;
    }
    EXPECT_EQ(worst[l], greatest);
    EXPECT_EQ(all("/verdicts/broken_in")[l], broken);
    EXPECT_EQ(all("/verdicts/runs")[l], static_cast<double>(found.size() / limit.size()));
    EXPECT_EQ(all("/verdicts/margin")[l], 1.0 - greatest / limit[l]);
  }
}

void expect_runs_alone(const Values& options, double of_peaks) {
  Results sweep =
      run_yaml(decks, options + Values{{"limits", limits}, {"sweep_speed", "20,60,20"}, {"sweep_refine", "0"}});
  for (std::size_t run = 0; run < 3; ++run) {
    Results alone = run_yaml(
        decks, options + Values{{"limits", limits}, {"load_speed", std::to_string(20 + 20 * static_cast<int>(run))}});
    const std::vector<double> found = row(sweep, "/sweep/judged", run, 5), wanted = alone("/verdicts/value");
    for (std::size_t l = 0; l < 3; ++l) EXPECT_NEAR(found[l], wanted[l], 1e-9 * wanted[l]) << run << ", limit " << l;
    for (std::size_t l = 3; l < 5; ++l)
      EXPECT_NEAR(found[l], wanted[l], of_peaks * wanted[l]) << run << ", limit " << l;
    EXPECT_EQ(row(sweep, "/sweep/judged_x", run, 5)[2], 20.0);  // the joint
  }
  expect_verdicts(sweep, "/sweep/judged");
}

TEST(JudgedRuns, OfASweepByElements) { expect_runs_alone({{"ts_dt", "2e-3"}}, 1e-9); }

// Peaks of a sweep by modes are looked for at more instants than those of a run by itself; filtered accelerations and
// rotations at the same ones.
TEST(JudgedRuns, OfASweepByModes) { expect_runs_alone({{"model_modes", "6"}}, 2e-3); }

// Coaches on a rough track, judged by every quantity of a run, in batches and one by one, with other steps.
TEST(JudgedRuns, OfVehiclesInBatches) {
  const TemporaryFolder folder;
  const std::vector<std::string> quantities = {"deck_acceleration",    "unfiltered_deck_acceleration",
                                               "deflection_over_span", "end_rotation",
                                               "joint_rotation",       "car_acceleration",
                                               "wheel_unloading",      "filtered_wheel_unloading",
                                               "unloading_time",       "contact_loss",
                                               "amplification"};
  std::string all;
  for (const std::string& quantity : quantities) all += "- {clause: A, quantity: " + quantity + ", value: 1.0}\n";
  const std::string scene = R"(
beam: {spans: [20.0, 25.0], EI: 2.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 8}
beam_continuity: simply_supported
support: {types: [pinned, roller, roller]}
vehicle_coach_file: )" + source_folder() +
                            R"(/options/vehicles/s300.yml
train: {vehicles: coach*2, spacing: 25.0}
track: {profile: german_low, seed: 3}
model: {vehicles: linear}
scene: {tail: 0.5}
sweep: {speed: "30,50,10", refine: 0}
output: {unloading_level: 0.02}
)";
  const auto judged = [&](const char* lanes, const char* step) {
    Results sweep =
        run_yaml(scene, {{"limits", folder.write("limits.yml", all)}, {"sweep_lanes", lanes}, {"ts_dt", step}});
    return sweep("/sweep/judged");
  };
  const std::vector<double> alone = judged("0", "2.5e-4"), fine = judged("8", "2.5e-4");
  for (std::size_t l = 0; l < quantities.size(); ++l) {
    double largest = 0.0, of_fine = 0.0;
    for (std::size_t i = l; i < alone.size(); i += quantities.size()) {
      largest = std::max(largest, alone[i]);
      of_fine = std::max(of_fine, std::abs(fine[i] - alone[i]));
    }
    EXPECT_TRUE(largest > 0.0 || quantities[l] == "contact_loss") << quantities[l];
    // The times of crossing a level are interpolated between instants that differ.
    const double bound = quantities[l] == "unloading_time" ? 5e-3 : 1e-3;
    EXPECT_LE(of_fine, bound * largest) << quantities[l];
  }
}

TEST(JudgedRuns, OfAStudy) {
  Results study = run_yaml(decks + "ts_dt: 2.0e-3\n", {{"limits", limits},
                                                       {"study_vary_beam_EI", "1e10,2e10"},
                                                       {"study_vary_load_speed", "30,50"},
                                                       {"study_statistics_over", "load_speed"}});
  std::size_t run = 0;
  for (const char* EI : {"1e10", "2e10"})
    for (const char* speed : {"30", "50"}) {
      Results alone = run_yaml(decks + "ts_dt: 2.0e-3\n", {{"limits", limits}, {"beam_EI", EI}, {"load_speed", speed}});
      const std::vector<double> found = row(study, "/study/judged", run++, 5), wanted = alone("/verdicts/value");
      for (std::size_t l = 0; l < 5; ++l) EXPECT_NEAR(found[l], wanted[l], 1e-9 * wanted[l]);
    }
  expect_verdicts(study, "/study/judged");
  const std::vector<double> mean = study("/study/statistics/judged_mean"), found = study("/study/judged");
  ASSERT_EQ(mean.size(), 10U);  // two stiffnesses, five limits
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(mean[i], 0.5 * (found[i / 5 * 10 + i % 5] + found[i / 5 * 10 + 5 + i % 5]), 1e-12 * mean[i]);
}

}  // namespace
}  // namespace traverse::test
