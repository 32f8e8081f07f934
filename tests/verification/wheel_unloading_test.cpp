// What a run says of its wheels' unloading, without and with a low-pass, against its own stored forces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "run/low_pass.hpp"
#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

/// The largest part of its first value that a series lacks.
double lost(const std::vector<double>& force, double at_rest) {
  return 1.0 - *std::min_element(force.begin(), force.end()) / at_rest;
}

const std::string coach = "options_file: " + source_folder() +
                          "/options/scenes/three_span_train.yml\n"
                          "train_vehicles: coach*2\nbeam_elements_per_span: 8\n"
                          "track: {profile: german_low, seed: 4, wavelengths: [2.0, 80.0]}\n";

// Every step is an instant: nothing but the parabola at the peak is between both, and instants are 20 a period of 20
// Hz.
TEST(WheelUnloadingOfARun, IsThatOfItsStoredForces) {
  for (const char* modes : {"0", "8"}) {
    Results run = run_yaml(coach, {{"ts_dt", "1e-3"},
                                   {"output_interval", "1e-3"},
                                   {"model_modes", modes},
                                   {"output_wheel_lowpass", "20"},
                                   {"output_unloading_level", "0.1"}});
    double raw = 0.0, filtered = 0.0, longest = 0.0;
    for (const char* vehicle : {"0", "1"})
      for (const char* wheel : {"1", "2", "3", "4"}) {
        std::vector<double> force =
            run.column(std::string("/vehicles/") + vehicle + "/wheel_" + wheel + "/normal_force");
        const double at_rest = force.front();
        raw = std::max(raw, lost(force, at_rest));
        run::LowPass(20.0, 1e-3).apply(force);
        force.resize(force.size() - 150);  // three periods of the filter, which lack the later forces
        filtered = std::max(filtered, lost(force, at_rest));
        double since = 0.0;
        for (const double f : force) {
          since = 1.0 - f / at_rest > 0.1 ? since + 1e-3 : 0.0;
          longest = std::max(longest, since);
        }
      }
    EXPECT_GT(raw, 1.2 * filtered) << "the filter has something to take away";
    EXPECT_NEAR(run.attribute("/summary", "wheel_unloading"), raw, 0.02 * raw) << modes;
    EXPECT_NEAR(run.attribute("/summary", "wheel_unloading_lowpass"), filtered, 2e-3 * filtered) << modes;
    EXPECT_GT(longest, 5e-3);
    EXPECT_NEAR(run.attribute("/summary", "unloading_longest"), longest, 1.01e-3) << modes;
    RecordProperty(std::string("filtered by modes ") + modes,
                   text(std::abs(run.attribute("/summary", "wheel_unloading_lowpass") / filtered - 1.0)));
  }
}

// The limits of a sweep find what single runs find.
TEST(WheelUnloadingOfARun, IsJudgedInSweeps) {
  const Values options = {{"ts_dt", "1e-3"},
                          {"model_modes", "8"},
                          {"sweep_lanes", "0"},
                          {"output_unloading_level", "0.1"},
                          {"limits", source_folder() + "/tests/data/limits_of_wheels.yml"}};
  Results sweep = run_yaml(coach, options + Values{{"sweep_speed", "60,80,10"}, {"sweep_refine", "0"}});
  const std::vector<double> judged = sweep("/sweep/judged");
  ASSERT_EQ(judged.size(), 9u);
  for (std::size_t run = 0; run < 3; ++run) {
    Results alone = run_yaml(coach, options + Values{{"train_speed", std::to_string(60 + 10 * static_cast<int>(run))}});
    EXPECT_EQ(judged[3 * run], alone("/verdicts/value")[0]);
    EXPECT_EQ(judged[3 * run + 1], alone("/verdicts/value")[1]);
    EXPECT_EQ(judged[3 * run + 2], alone("/verdicts/value")[2]);
    EXPECT_EQ(alone("/verdicts/value")[0], alone.attribute("/summary", "wheel_unloading"));
    EXPECT_EQ(alone("/verdicts/value")[1], alone.attribute("/summary", "wheel_unloading_lowpass"));
    EXPECT_EQ(alone("/verdicts/value")[2], alone.attribute("/summary", "unloading_longest"));
  }
}

}  // namespace
}  // namespace traverse::test
