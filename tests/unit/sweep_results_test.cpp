// What a sweep says of its peaks: each number with the train, speed and probe that it belongs to.
#include <gtest/gtest.h>

#include <map>

#include "results/sweep.hpp"

namespace traverse::results {
namespace {

/// Trains A2 and A7 at 40 and 50 m/s, probes at 5 and 10 m. The greatest deflection is that of A7 at 50 m/s and 10 m;
/// the greatest amplification that of A2 at 40 m/s and 5 m.
Sweep small_sweep() {
  Sweep sweep;
  sweep.speed = {40.0, 50.0};
  sweep.trains = {2, 7};
  sweep.probes = {5.0, 10.0};
  sweep.deflection = {{1e-3, 2e-3, 0.5e-3, 1.5e-3, 2e-3, 3e-3, 3e-3, 4e-3}, std::vector<double>(8, 0.25)};
  sweep.acceleration = sweep.moment = sweep.deflection;
  sweep.static_deflection = {0.1e-3, 1e-3, 1.5e-3, 2e-3};
  sweep.amplification = {10.0, 2.0, 5.0, 1.5, 4.0 / 3.0, 1.5, 2.0, 2.0};
  sweep.least_wheel_force = {9e4, 8e4, 7e4, 6e4};
  sweep.greatest_wheel_force = {11e4, 14e4, 13e4, 12e4};
  sweep.contact_losses = {0.0, 1.0, 0.0, 2.0};
  sweep.longest_loss = {0.0, 0.01, 0.0, 0.005};
  sweep.model = {3, 24, false, 0.0, 1e-2, {{"deflection", 2e-3}}};
  return sweep;
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
  const auto found = numbers(summary_of(small_sweep(), {4, 4, 1.5, "reached its end"}));
  const std::map<std::string, double> wanted = {{"deflection", 4e-3},
                                                {"deflection_place", 10.0},
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
                                                {"longest_loss", 0.01},
                                                {"expected_error_deflection", 2e-3},
                                                {"runs", 4.0},
                                                {"runs_planned", 4.0}};
  for (const auto& [name, value] : wanted) {
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_EQ(found.at(name), value) << name;
  }
  EXPECT_FALSE(found.contains("steps"));
}

TEST(SweepResults, SummaryLeavesOutWhatIsNotKnown) {
  Sweep sweep = small_sweep();
  for (auto* values :
       {&sweep.least_wheel_force, &sweep.greatest_wheel_force, &sweep.contact_losses, &sweep.longest_loss})
    values->clear();
  sweep.static_deflection.assign(4, Sweep::not_run);
  sweep.amplification.assign(8, 0.0);
  auto found = numbers(summary_of(sweep, {4, 4, 1.5, "reached its end"}));
  for (const char* name : {"static_deflection", "amplification", "greatest_amplification", "least_wheel_force",
                           "greatest_wheel_force", "contact_losses", "energy_residual"})
    EXPECT_FALSE(found.contains(name)) << name;
  sweep.deflection.value.assign(8, Sweep::not_run);  // no run has ended
  EXPECT_FALSE(numbers(summary_of(sweep, {0, 4, 1.5, "ended by signal 15"})).contains("deflection"));
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
