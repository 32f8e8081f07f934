// Steps chosen by their errors (-ts_adapt_type ladder): what the tolerance promises and what it costs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "traverse/base/error.hpp"

namespace traverse::test {
namespace {

const Values bump = {{"output_interval", "8e-3"}};
const Values run_up = {{"train_positions", "-40"}, {"ts_max_time", "2"}};

Values ladder(const char* tolerance, const char* longest) {
  return {{"ts_adapt_type", "ladder"}, {"ts_rtol", tolerance}, {"ts_dt", longest}};
}

double steps(const Results& run) {
  return run.attribute("/summary", "steps") + run.attribute("/summary", "rejected_steps");
}

TEST(StepSizeControl, ErrorsFallWithTheTolerance) {
  Results exact = run_scene("wheel_over_a_bump", bump + Values{{"ts_dt", "4e-5"}});
  double deflection = 1.0, force = 1.0;
  for (const char* tolerance : {"1e-2", "1e-3", "1e-5", "1e-6"}) {
    Results run = run_scene("wheel_over_a_bump", bump + ladder(tolerance, "8e-3"));
    const double of_deflection = relative_difference(run("/probes/deflection"), exact("/probes/deflection"));
    const double of_force =
        relative_difference(run("/vehicles/0/wheel/normal_force"), exact("/vehicles/0/wheel/normal_force"));
    RecordProperty(std::string("deflection_") + tolerance, text(of_deflection));
    RecordProperty(std::string("force_") + tolerance, text(of_force));
    EXPECT_LT(of_deflection, 0.3 * deflection) << tolerance;
    EXPECT_LT(of_force, 0.3 * force) << tolerance;
    EXPECT_LT(of_deflection, 5.0 * std::stod(tolerance)) << tolerance;
    deflection = of_deflection;
    force = of_force;
  }
}

// Where the motion is quiet before and behind a bump steps of one length cost more, whichever length it is.
TEST(StepSizeControl, ABumpTakesFewerStepsThanAnyOfOneLength) {
  Results exact = run_scene("wheel_over_a_bump", bump + run_up + Values{{"ts_dt", "5e-5"}});
  const auto error = [&](Results& run) {
    return relative_difference(run("/vehicles/0/wheel/normal_force"), exact("/vehicles/0/wheel/normal_force"));
  };
  Results chosen = run_scene("wheel_over_a_bump", bump + run_up + ladder("1e-5", "8e-3"));
  RecordProperty("ladder", text(steps(chosen)) + " " + text(error(chosen)));
  for (const char* step : {"2e-3", "1e-3", "5e-4", "2.5e-4"}) {
    Results one = run_scene("wheel_over_a_bump", bump + run_up + Values{{"ts_dt", step}});
    RecordProperty(step, text(steps(one)) + " " + text(error(one)));
    EXPECT_TRUE(error(one) > 2.0 * error(chosen) || steps(one) > 2.0 * steps(chosen)) << step;
  }
}

TEST(StepSizeControl, ASmoothCrossingHasThePeaksOfAFineRun) {
  const Values coaches = {{"train_vehicles", "coach*2"}, {"beam_elements_per_span", "10"}, {"output_interval", "2e-2"}};
  Results fine = run_scene("three_span_train", coaches + Values{{"ts_dt", "4e-4"}});
  Results run = run_scene("three_span_train", coaches + ladder("1e-5", "2e-2"));
  for (const char* curve : {"/probes/deflection", "/probes/moment"}) {
    const double difference = relative_difference(run(curve), fine(curve));
    RecordProperty(curve + 1, text(difference));
    EXPECT_LT(difference, 1e-4) << curve;
  }
  for (const char* peak : {"deflection", "moment", "acceleration"}) {
    const double exact = fine.attribute("/summary", peak);
    EXPECT_NEAR(run.attribute("/summary", peak), exact, 1e-2 * std::abs(exact)) << peak;
  }
}

TEST(StepSizeControl, AHandfulOfFactorisationsServes) {
  Results run = run_scene("coach_over_a_bump", {{"beam_elements_per_span", "16"},
                                                {"output_interval", "1.6e-2"},
                                                {"ts_adapt_type", "ladder"},
                                                {"ts_dt", "1.6e-2"}});
  RecordProperty("steps", text(steps(run)));
  EXPECT_GT(steps(run), 1000);
  EXPECT_LT(run.attribute("/summary", "factorisations"), 12);
}

// An impact in free flight, found by its error alone: the bounces have their durations.
TEST(StepSizeControl, ImpactsNeedNoStepsOfTheirOwn) {
  const Values ball = {{"contact_impact_steps", "0"}, {"contact_tolerance", "1e-8"}, {"ts_max_time", "2"}};
  Results exact = run_scene("bouncing_ball",
                            {{"contact_impact_steps", "200"}, {"contact_tolerance", "1e-10"}, {"ts_max_time", "2"}});
  Results run = run_scene("bouncing_ball", ball + ladder("1e-5", "1e-2"));
  RecordProperty("steps", text(steps(run)));
  EXPECT_LT(relative_difference(run("/separations/duration"), exact("/separations/duration")), 1e-4);
  EXPECT_LT(steps(run), 3000);
}

TEST(StepSizeControl, IsRefusedWhereErrorsHaveNoMeasure) {
  EXPECT_THROW(run_scene("prop_with_gap", {{"ts_adapt_type", "ladder"}}), InputError);
  EXPECT_THROW(run_scene("r4_hertz_wheel", {{"ts_adapt_type", "ladder"}, {"ts_type", "genalpha"}}), InputError);
  EXPECT_THROW(run_scene("r4_hertz_wheel", ladder("0", "1e-2")), InputError);
}

}  // namespace
}  // namespace traverse::test
