// Linear vehicles by passes over their contacts (engine/linear_train.hpp) against the Newton iteration of all contacts
// (coupling/contact_newton.hpp), which a damper takes over that is too small to be felt.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/message.hpp"
#include "support/temporary_folder.hpp"

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

/// The differences of both ways.
void expect_same(Results& passes, Results& newton, double bound) {
  for (const char* curve : curves) {
    const double difference = relative_difference(passes(curve), newton(curve));
    testing::Test::RecordProperty(curve + 1, text(difference));
    EXPECT_LE(difference, bound) << curve;
  }
  EXPECT_GT(relative_difference(passes(curves[3]), newton(curves[3])), 0.0) << "both are the same run";
}

TEST_P(Passes, SameAsNewtonOfAllContacts) {
  const Case& c = GetParam();
  const Values scene = Values{{"train_vehicles", "coach*2"},
                              {"beam_elements_per_span", "8"},
                              {"model_modes", "0"},
                              {"model_vehicles", "linear"},
                              {"ts_dt", "1e-3"},
                              {"scene_tail", "0.1"}} +
                       c.options;
  Values damped = scene;
  for (const char* wheel : {"1", "2", "3", "4"})
    damped.emplace_back("vehicle_coach_wheel_" + std::string(wheel) + "_damping", "1e-9");
  Results passes = run_scene("three_span_train", scene), newton = run_scene("three_span_train", damped);
  expect_same(passes, newton, c.bound);
}

// A train that brakes, with the work of its drives.
// Steps end where the contact turns about the joint between two decks, and it stays exactly there within them: the
// height of the track there has to be known on the other deck too.
TEST(LinearTrain, OnARoughTrackOverAJoint) {
  const std::string scene = R"(
beam: {spans: [20.0, 25.0], EI: 2.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 8}
beam_continuity: simply_supported
support: {types: [pinned, roller, roller]}
vehicle_coach_file: )" + source_folder() +
                            R"(/options/vehicles/s300.yml
train: {vehicles: coach, speed: 40}
track: {profile: german_low, seed: 3}
ts: {dt: 2.5e-4, max_time: 0.6}
output: {probes: 22.5}
step_probes: true
)";
  Results linear = run_yaml(scene, {{"model_vehicles", "linear"}}),
          full = run_yaml(scene, {{"model_vehicles", "full"}});
  for (const char* name : {"least_wheel_force", "greatest_wheel_force"})
    EXPECT_NEAR(linear.attribute("/summary", name), full.attribute("/summary", name),
                1e-3 * full.attribute("/summary", name))
        << name;
}

TEST(LinearTrain, AtAChangingSpeed) {
  const TemporaryFolder folder;
  const std::string law = folder.write("law.csv", "0,50\n0.4,50\n1,47\n1.6,47\n");
  const auto scene = [&](const char* damping) {
    return "beam: {spans: [32, 40, 32], EI: 3.795e11, EA: 3.1e11, mass: 3e4, elements_per_span: 8}\n"
           "support: {types: [pinned, roller, roller, roller]}\nts: {dt: 1e-3, max_time: 1.6}\n"
           "vehicle: {coach: {file: " +
           source_folder() + "/options/vehicles/velaro.yml, wheel_1: {damping: " + std::string(damping) +
           "}}}\ntrain: {vehicles: coach*2, speed_file: " + law + "}\n";
  };
  const Values linear = {{"model_vehicles", "linear"}};
  Results passes = run_yaml(scene("0"), linear), newton = run_yaml(scene("1e-9"), linear);
  expect_same(passes, newton, 1e-8);
  EXPECT_LT(relative_difference(passes("/energy/work"), newton("/energy/work")), 1e-9);
  EXPECT_LT(energy_error(passes), 1e-9);
}

// Between samples peaks are looked for in the contacts' forces that the step has ended with, without the vehicles.
TEST(LinearTrain, PeaksBetweenSamples) {
  const Values scene = {{"train_vehicles", "coach*2"}, {"beam_elements_per_span", "8"},
                        {"model_modes", "0"},          {"model_vehicles", "linear"},
                        {"step_probes", "true"},       {"ts_dt", "1e-3"},
                        {"output_interval", "0.5"},    {"scene_tail", "0.1"}};
  Values damped = scene;
  for (const char* wheel : {"1", "2", "3", "4"})
    damped.emplace_back("vehicle_coach_wheel_" + std::string(wheel) + "_damping", "1e-9");
  Results passes = run_scene("three_span_train", scene), newton = run_scene("three_span_train", damped);
  for (const char* name : {"deflection", "acceleration", "moment", "shear", "greatest_wheel_force", "linear_defect"}) {
    const double off = std::abs(passes.attribute("/summary", name) / newton.attribute("/summary", name) - 1.0);
    RecordProperty(name, text(off));
    // Of the residual the departure from the start tells the size, and not how its parts add up.
    EXPECT_LT(off, std::string_view(name) == "linear_defect" ? 0.3 : 1e-8) << name;
  }
}

// Everything is left open: mesh, step and linear vehicles are chosen, and keep to the accuracy against the mechanisms.
TEST(LinearTrain, ChosenByTheAccuracy) {
  const Values scene = {{"train_vehicles", "coach*2"}, {"scene_tail", "0.2"}};
  Results chosen = run_scene("fifty_metre_train", scene + Values{{"accuracy", "1e-3"}});
  Results exact = run_scene("fifty_metre_train", scene + Values{{"ts_dt", "1e-4"},
                                                                {"beam_elements_per_span", "64"},
                                                                {"model_vehicles", "full"},
                                                                {"step_probes", "true"}});
  for (const char* name : {"deflection", "acceleration", "moment", "greatest_wheel_force"}) {
    const double off = std::abs(chosen.attribute("/summary", name) / exact.attribute("/summary", name) - 1.0);
    RecordProperty(name, text(off));
    EXPECT_LT(off, 1e-3) << name;
  }
}

// A step ends where a wheel would be at a corner of the surface that had not moved along the track.
TEST(LinearTrain, PassesCornersWhereItHasMovedTo) {
  const Values coarse = {{"model_vehicles", "linear"}, {"step_probes", "true"}, {"ts_dt", "2e-4"}};
  const Values fine = coarse + Values{{"ts_dt", "1e-4"}};
  const std::string scene =
      "beam: {spans: 29.3, elements_per_span: 96, EI: 4.70444e+10, mass: 4283.07, damping_ratios: 0.0062}\n"
      "vehicle: {coach: {file: " +
      source_folder() + "/options/vehicles/velaro.yml}}\ntrain: {vehicles: coach*2, speed: 23.5}\nmodel: {modes: 0}\n";
  Results with_coarse = run_yaml(scene, coarse), with_fine = run_yaml(scene, fine);
  const double by_steps = std::abs(
      with_coarse.attribute("/summary", "acceleration") / with_fine.attribute("/summary", "acceleration") - 1.0);
  RecordProperty("steps", text(by_steps));
  EXPECT_LT(by_steps, 1e-4);
}

}  // namespace
}  // namespace traverse::test
