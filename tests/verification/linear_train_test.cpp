// Linear vehicles by passes over their contacts (engine/linear_train.hpp) against the Newton iteration of all contacts
// (coupling/contact_newton.hpp), which a damper takes over that is too small to be felt.
#include <gtest/gtest.h>

#include <string>

#include "support/curve.hpp"
#include "support/message.hpp"

namespace traverse::test {
namespace {

constexpr const char* curves[] = {"/probes/deflection", "/probes/moment", "/supports/reaction",
                                  "/vehicles/0/wheel_1/normal_force", "/vehicles/1/rear_bogie/position"};

struct Case {
  const char* name;
  Values options;
  double bound = 1e-8;  // of each curve's peak
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Passes : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    LinearTrain, Passes,
    testing::Values(
        Case{"several_spans", {}}, Case{"one_solve_a_step", {{"ts_type", "genalpha"}}},
        Case{"to_the_left", {{"train_speed", "-83.333"}}},
        Case{"separate_spans", {{"beam_continuity", "simply_supported"}}},  // where a wheel passes the end of a beam
                                                                            // that shears its slope jumps within a step
        Case{"shear", {{"beam_GA", "1e9"}}, 1e-7}, Case{"raised_surface", {{"beam_surface_height", "1.5"}}},
        Case{"along_the_beam", {{"beam_surface_height", "1.5"}, {"beam_EA", "1e10"}, {"model_axial", "true"}}},
        Case{"elements_that_bend_inside", {{"contact_seats", "true"}}},
        Case{"rough_track", {{"track_profile", "german_low"}, {"track_seed", "3"}, {"ts_dt", "2e-4"}}},
        Case{"modes", {{"model_modes", "16"}}}, Case{"hinge", {{"beam_hinges", "40"}}}),
    [](const auto& which) { return which.param.name; });

TEST_P(Passes, SameAsNewtonOfAllContacts) {
  const Case& c = GetParam();
  const Values scene = Values{{"train_vehicles", "coach*2"}, {"beam_elements_per_span", "8"}, {"model_modes", "0"},
                              {"model_vehicles", "linear"},  {"step_lanes", "false"},         {"ts_dt", "1e-3"},
                              {"scene_tail", "0.1"}} +
                       c.options;
  Values damped = scene;
  for (const char* wheel : {"1", "2", "3", "4"})
    damped.emplace_back("vehicle_coach_wheel_" + std::string(wheel) + "_damping", "1e-9");
  Results passes = run_scene("three_span_train", scene), newton = run_scene("three_span_train", damped);
  for (const char* curve : curves) {
    const double difference = relative_difference(passes(curve), newton(curve));
    RecordProperty(curve + 1, text(difference));
    EXPECT_LE(difference, c.bound) << curve;
  }
  EXPECT_GT(relative_difference(passes(curves[3]), newton(curves[3])), 0.0) << "both are the same run";
}

}  // namespace
}  // namespace traverse::test
