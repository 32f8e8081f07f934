// Single runs of linear vehicles over modes by the lanes' kernel (step_lanes) against the same runs by the system
// itself: the kernel takes the contact's normal by its first power. What is left falls with the slopes of bridge and
// track, and so does what the energies miss.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/paths.hpp"
#include "support/separations.hpp"

namespace traverse::test {
namespace {

const Values linear = {{"model_vehicles", "linear"}, {"model_modes", "8"}, {"step_probes", "true"}};

// Without the probes: what modes left out do there the system takes as static.
const char* const series[] = {"/supports/reaction", "/vehicles/0/wheel_3/normal_force",
                              "/vehicles/0/rear_bogie/acceleration"};

/// The largest difference of these series, each over its own largest value.
double difference(Results& a, Results& b) {
  double worst = 0.0;
  for (const char* name : series) worst = std::max(worst, relative_difference(a(name), b(name)));
  return worst;
}

struct Pair {
  Results apart, itself;
};
Pair run_both(const std::string& scene, const Values& options) {
  return {run_scene(scene, options), run_scene(scene, options + Values{{"step_lanes", "false"}})};
}

void expect_same_motion(const char* name, const std::string& scene, const Values& options, double bound,
                        double unbalanced) {
  Pair runs = run_both(scene, linear + options);
  const double off = difference(runs.apart, runs.itself);
  testing::Test::RecordProperty(name, text(off));
  EXPECT_LT(off, bound) << name;
  EXPECT_GT(off, 0.0) << "both are the same run";
  EXPECT_LT(std::abs(peak(runs.apart("/balance/residual")).first),
            1e-9 * std::abs(peak(runs.apart("/balance/load")).first));
  EXPECT_LT(energy_error(runs.apart), unbalanced);
}

TEST(SteppedApart, CoachesOverThreeSpans) {
  expect_same_motion("three spans", "three_span_train",
                     {{"train_vehicles", "coach*2"}, {"scene_tail", "0.2"}, {"ts_dt", "2.5e-4"}}, 1e-6, 3e-5);
}

// A coach that pitches takes its wheels along the track, by millimetres, and wheels touch slopes ahead of their
// centres: where the kernels had them below their guides deflections were 1.1e-5 and 5e-5 off.
TEST(SteppedApart, WheelsMoveAlongTheTrack) {
  for (const char* bridge : {"{spans: 24.5, EI: 3.32086e+10, mass: 3080.48, damping_ratios: 0.0127}\n",
                             "{spans: 40.0*2, EI: 6e+10, mass: 4000.0, continuity: simply_supported}\n"}) {
    const std::string scene = "beam: " + std::string(bridge) +
                              "vehicle: {coach: {file: " TRAVERSE_SOURCE_DIR
                              "/options/vehicles/velaro.yml}}\ntrain: {vehicles: coach, speed: 20.9}\n";
    const Values options = {{"model_vehicles", "linear"},
                            {"model_modes", "24"},
                            {"beam_elements_per_span", "40"},
                            {"step_probes", "true"},
                            {"ts_dt", "2e-4"}};
    Results apart = run_yaml(scene, options), itself = run_yaml(scene, options + Values{{"step_lanes", "false"}});
    for (const auto& [name, bound] : {std::pair{"deflection", 5e-7}, {"moment", 3e-5}}) {
      const double off = std::abs(apart.attribute("/summary", name) / itself.attribute("/summary", name) - 1.0);
      RecordProperty(name, text(off));
      EXPECT_LT(off, bound) << name << " of " << bridge;
      EXPECT_GT(off, 0.0) << "both are the same run";
    }
  }
}

// A step ends where a wheel would be at a corner of the surface that had not moved along the track. Where accelerations
// did not change there, peaks depended on the steps that followed, with the first power of their length; where what was
// missed until then was not made up for, forces were 6e-5 off.
TEST(SteppedApart, WheelsPassCornersWhereTheyHaveMovedTo) {
  const Values coarse = {{"model_vehicles", "linear"}, {"step_probes", "true"}, {"ts_dt", "2e-4"}};
  const Values fine = coarse + Values{{"ts_dt", "1e-4"}};
  for (const auto& [spans, elements, modes] :
       {std::tuple("29.3", "96", "48"), {"29.3*2, continuity: simply_supported", "24", "0"}}) {
    const std::string scene = "beam: {spans: " + std::string(spans) +
                              ", EI: 4.70444e+10, mass: 4283.07, damping_ratios: 0.0062}\n"
                              "vehicle: {coach: {file: " TRAVERSE_SOURCE_DIR
                              "/options/vehicles/velaro.yml}}\ntrain: {vehicles: coach*2, speed: 23.5}\n";
    const Values mesh = {{"beam_elements_per_span", elements}, {"model_modes", modes}};
    Results with_coarse = run_yaml(scene, mesh + coarse), with_fine = run_yaml(scene, mesh + fine),
            itself = run_yaml(scene, mesh + fine + Values{{"step_lanes", "false"}});
    const auto off = [](Results& a, Results& b, const char* name) {
      return std::abs(a.attribute("/summary", name) / b.attribute("/summary", name) - 1.0);
    };
    const double by_steps = off(with_coarse, with_fine, "acceleration");
    const double of_force = off(with_fine, itself, "greatest_wheel_force");
    RecordProperty("steps", text(by_steps));
    RecordProperty("force", text(of_force));
    EXPECT_LT(by_steps, 1e-4) << spans;
    EXPECT_LT(of_force, 1e-5) << spans;
    EXPECT_GT(of_force, 0.0) << "both are the same run";
  }
}

// The modes left out have accelerations, and moments that lag: against the elements, beside the system, in which they
// are static.
TEST(SteppedApart, ModesLeftOut) {
  const Values scene = {{"train_vehicles", "coach*2"}, {"scene_tail", "0.2"}, {"model_vehicles", "linear"},
                        {"step_probes", "true"},       {"ts_dt", "2.5e-4"},   {"output_interval", "1e-3"}};
  Results elements = run_scene("three_span_train", scene + Values{{"beam_elements_per_span", "100"}});
  const Values modes = scene + Values{{"model_modes", "24"}, {"beam_elements_per_span", "40"}};
  Results apart = run_scene("three_span_train", modes);
  Results itself = run_scene("three_span_train", modes + Values{{"step_lanes", "false"}});
  for (const auto& [name, bound, part] : {std::tuple("/probes/deflection", 2e-5, 2.0),
                                          {"/probes/acceleration", 2e-2, 0.5},
                                          {"/probes/moment", 2e-4, 0.15}}) {
    const double off = relative_difference(apart(name), elements(name));
    testing::Test::RecordProperty(name + 1, text(off));
    EXPECT_LT(off, bound) << name;
    EXPECT_LT(off, part * relative_difference(itself(name), elements(name))) << name;
  }
}

TEST(SteppedApart, RoughTrack) {
  expect_same_motion("rough track", "three_span_train",
                     {{"train_vehicles", "coach"},
                      {"scene_tail", "0.1"},
                      {"track_profile", "german_low"},
                      {"track_seed", "3"},
                      {"ts_dt", "2e-4"}},
                     5e-5, 1e-3);
}

TEST(SteppedApart, OneSolveAStep) {
  Pair runs = run_both(
      "three_span_train",
      linear + Values{{"train_vehicles", "coach"}, {"scene_tail", "0.1"}, {"ts_dt", "5e-5"}, {"ts_type", "genalpha"}});
  EXPECT_LT(difference(runs.apart, runs.itself), 1e-3);  // the kernel's modes move exactly, those of the system do not
  EXPECT_LT(energy_error(runs.apart), 3e-4);
}

/// Wheels fly over a bump: from then on the system goes on by itself, and finds the same losses to `close` s. Returns
/// when the first one begins, s.
double expect_same_losses(const Values& bump, double close, double bound) {
  Pair runs =
      run_both("three_span_train", linear + Values{{"train_vehicles", "coach"}, {"track_profile", "bump"}} + bump);
  const std::vector<Separated> losses = separations(runs.apart), same = separations(runs.itself);
  EXPECT_LT(difference(runs.apart, runs.itself), bound);
  EXPECT_EQ(losses.size(), same.size());
  if (losses.empty() || losses.size() != same.size()) return -1.0;
  for (std::size_t i = 0; i < losses.size(); ++i) {
    EXPECT_NEAR(losses[i].start, same[i].start, close);
    EXPECT_NEAR(losses[i].duration, same[i].duration, 1e-3 * same[i].duration + close);
  }
  return losses.front().start;
}

TEST(SteppedApart, GivesBackWhereContactIsLost) {
  const double first = expect_same_losses({{"scene_tail", "0.1"},
                                           {"track_bump_start", "20"},
                                           {"track_bump_length", "2"},
                                           {"track_bump_height", "4e-3"},
                                           {"ts_dt", "2.5e-4"}},
                                          1e-5, 5e-3);
  EXPECT_GT(first, 0.1);
}

// A wheel starts at the top of the bump and flies before TS has set anything up. It begins with the velocity of the
// surface, whose slope there is 0.024: linear vehicles leave out its square, 6e-4 of that velocity.
TEST(SteppedApart, GivesBackInTheFirstStep) {
  const double first = expect_same_losses({{"ts_max_time", "0.03"},
                                           {"track_bump_start", "-2.72"},
                                           {"track_bump_length", "0.4"},
                                           {"track_bump_height", "1e-2"},
                                           {"ts_dt", "2e-4"}},
                                          1e-7, 1e-4);
  EXPECT_GT(first, 0.0);
  EXPECT_LT(first, 2e-4);
}

// Everything is left open: modes and linear vehicles are chosen for a single run, and keep to the accuracy against the
// elements with the mechanisms.
TEST(SteppedApart, ChosenByTheAccuracy) {
  const Values scene = {{"train_vehicles", "coach*2"}, {"scene_tail", "0.2"}};
  Results chosen = run_scene("fifty_metre_train", scene + Values{{"accuracy", "1e-3"}});
  EXPECT_GT(chosen("/modes/frequency").size(), 3U);
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

}  // namespace
}  // namespace traverse::test
