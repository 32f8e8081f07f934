// What a sweep says of its peaks: each number with the train, speed and probe that it belongs to.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "results/study_table.hpp"
#include "results/sweep.hpp"

namespace traverse::results {
namespace {

constexpr double unknown = StudyTable::not_run;

/// Trains A2 and A7 at 40 and 50 m/s.
const options::Study& small_study() {
  static const options::Study study = sweep_study({2, 7}, {40.0, 50.0});
  return study;
}

struct Numbers {
  std::array<double, 2> deflection, static_deflection;  // of both probes
  double least, greatest, losses, longest;
};

/// A run by its peaks, that of the accelerations and of the moments like those of the deflection; probes at 5 and 10 m.
void put(StudyTable& table, std::size_t run, const Numbers& n, bool wheels) {
  std::vector<double> row = {5.0, 10.0};
  for (int i = 0; i < 3; ++i) row.insert(row.end(), {n.deflection[0], n.deflection[1], 0.25, 0.25});
  row.insert(row.end(), {n.static_deflection[0], n.static_deflection[1]});
  row.insert(row.end(), {n.deflection[0] / n.static_deflection[0], n.deflection[1] / n.static_deflection[1]});
  if (wheels) row.insert(row.end(), {n.least, n.greatest, n.losses, n.longest});
  row.push_back(0.0);
  table.put(run, row.data());
}

/// The greatest deflection is that of A7 at 50 m/s and 10 m; the greatest amplification that of A2 at 40 m/s and 5 m.
StudyTable small_sweep() {
  StudyTable table(small_study(), 2, true);
  put(table, 0, {{1e-3, 2e-3}, {0.1e-3, 1e-3}, 9e4, 11e4, 0.0, 0.0}, true);
  put(table, 1, {{0.5e-3, 1.5e-3}, {0.1e-3, 1e-3}, 8e4, 14e4, 1.0, 0.01}, true);
  put(table, 2, {{2e-3, 3e-3}, {1.5e-3, 2e-3}, 7e4, 13e4, 0.0, 0.0}, true);
  put(table, 3, {{3e-3, 4e-3}, {1.5e-3, 2e-3}, 6e4, 12e4, 2.0, 0.005}, true);
  return table;
}

std::map<std::string, double> numbers(const std::vector<Attribute>& list) {
  std::map<std::string, double> found;
  for (const Attribute& attribute : list) {
    if (const double* value = std::get_if<double>(&attribute.value)) found[attribute.name] = *value;
    if (const long* value = std::get_if<long>(&attribute.value)) found[attribute.name] = static_cast<double>(*value);
  }
  return found;
}

TEST(SweepResults, SummaryNamesTheRunOfEveryPeak) {
  const auto found = numbers(summary_of(small_sweep()));
  const std::map<std::string, double> wanted = {{"deflection", 4e-3},
                                                {"deflection_place", 10.0},
                                                {"deflection_time", 0.25},
                                                {"deflection_speed", 50.0},
                                                {"deflection_train", 7.0},
                                                {"static_deflection", 2e-3},
                                                {"amplification", 2.0},
                                                {"greatest_amplification", 10.0},
                                                {"greatest_amplification_place", 5.0},
                                                {"greatest_amplification_speed", 40.0},
                                                {"greatest_amplification_train", 2.0},
                                                {"least_wheel_force", 6e4},
                                                {"least_wheel_force_speed", 50.0},
                                                {"greatest_wheel_force", 14e4},
                                                {"contact_losses", 3.0},
                                                {"longest_loss", 0.01}};
  for (const auto& [name, value] : wanted) {
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_EQ(found.at(name), value) << name;
  }
  EXPECT_FALSE(found.contains("deflection_run")) << "which is how a study names it";
}

TEST(SweepResults, SummaryLeavesOutWhatIsNotKnown) {
  StudyTable table(small_study(), 2, false);
  EXPECT_TRUE(summary_of(table).empty()) << "no run has ended";
  for (std::size_t run = 0; run < 4; ++run) put(table, run, {{1e-3, 2e-3}, {unknown, unknown}, 0, 0, 0, 0}, false);
  const auto found = numbers(summary_of(table));
  EXPECT_EQ(found.at("deflection"), 2e-3);
  for (const char* name : {"static_deflection", "amplification", "greatest_amplification", "least_wheel_force",
                           "greatest_wheel_force", "contact_losses", "energy_residual"})
    EXPECT_FALSE(found.contains(name)) << name;
}

// As files of all versions have it.
TEST(SweepResults, DatasetsGoByTrainAndSpeed) {
  StudyTable table(small_study(), 2, true);
  put(table, 1, {{0.5e-3, 1.5e-3}, {0.1e-3, 1e-3}, 8e4, 14e4, 1.0, 0.01}, true);
  put(table, 2, {{2e-3, 3e-3}, {unknown, 2e-3}, 7e4, 13e4, 0.0, 0.0}, true);
  std::map<std::string, Recorder::Dataset> sets;
  for (const Recorder::Dataset& set : sweep_datasets(table, true)) sets[set.name] = set;
  EXPECT_EQ(sets.at("/sweep/speed").values, (std::vector<double>{40.0, 50.0}));
  EXPECT_EQ(sets.at("/sweep/hslm_a").values, (std::vector<double>{2.0, 7.0}));
  const Recorder::Dataset& deflection = sets.at("/sweep/peak_deflection");
  EXPECT_EQ(deflection.shape, (std::vector<std::size_t>{2, 2, 2}));
  EXPECT_EQ(deflection.values[2], 0.5e-3);
  EXPECT_EQ(deflection.values[5], 3e-3);
  EXPECT_TRUE(std::isnan(deflection.values[0])) << "not run";
  const Recorder::Dataset& rest = sets.at("/sweep/static_deflection");
  EXPECT_EQ(rest.shape, (std::vector<std::size_t>{2, 2}));
  EXPECT_EQ(rest.values[0], 0.1e-3);
  EXPECT_TRUE(std::isnan(rest.values[2]));
  EXPECT_EQ(rest.values[3], 2e-3);
  const Recorder::Dataset& amplification = sets.at("/sweep/amplification");
  EXPECT_EQ(amplification.values[4], 0.0) << "unknown";
  EXPECT_TRUE(std::isnan(amplification.values[0])) << "not run";
  EXPECT_EQ(sets.at("/sweep/least_wheel_force").shape, (std::vector<std::size_t>{2, 2}));
  EXPECT_EQ(sets.at("/sweep/promised").values[1], 1.0);
  EXPECT_FALSE(sets.contains("/sweep/probes_x"));
}

TEST(SweepResults, TableHasTheAmplificationOfEachPeakBesideIt) {
  ::testing::internal::CaptureStdout();
  print_sweep(small_sweep());
  const std::string text = ::testing::internal::GetCapturedStdout();
  EXPECT_NE(text.find("A2  2 mm @ 144, 10                  2  "), std::string::npos) << text;
  EXPECT_NE(text.find("10 @ 144, 5\n"), std::string::npos) << text;
  EXPECT_NE(text.find("A7  4 mm @ 180, 10                  2  "), std::string::npos) << text;
  EXPECT_NE(text.find("60 kN @ 180"), std::string::npos) << text;
}

TEST(SweepResults, MethodIsSaid) {
  EXPECT_EQ(method_of({1, 24}), "by 1 mode");
  EXPECT_EQ(method_of({0, 24, false, 5e-4}), "by 24 elements a span and steps of 0.0005 s");
  EXPECT_EQ(method_of({0, 2, true, 0.0}), "by 2 elements a sleeper bay");
}

}  // namespace
}  // namespace traverse::results
