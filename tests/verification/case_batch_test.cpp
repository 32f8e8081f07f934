// Runs of a sweep side by side (sweep_lanes) against the same runs each by itself, driven by PETSc's TS, and against
// the elements with the mechanisms themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string_view>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

const char* const peaks[] = {"peak_deflection", "peak_acceleration", "peak_moment", "greatest_wheel_force",
                             "least_wheel_force"};

using ResponseExtremes = std::map<std::string, std::vector<double>>;

ResponseExtremes peaks_of(Results results) {
  ResponseExtremes all;
  for (const char* name : peaks) all[name] = results(std::string("/sweep/") + name);
  return all;
}

/// The largest difference of one quantity over the largest of its kind.
double difference(const ResponseExtremes& a, const ResponseExtremes& b, const char* name) {
  double apart = 0.0, largest = 0.0;
  const std::vector<double>&x = a.at(name), &y = b.at(name);
  for (std::size_t i = 0; i < y.size(); ++i) {
    apart = std::max(apart, std::abs(x.at(i) - y[i]));
    largest = std::max(largest, std::abs(y[i]));
  }
  return apart / largest;
}

double difference(const ResponseExtremes& a, const ResponseExtremes& b, std::span<const char* const> names = peaks) {
  double worst = 0.0;
  for (const char* name : names) worst = std::max(worst, difference(a, b, name));
  return worst;
}

Values sweep(const char* speeds, const char* lanes, const char* step) {
  return {{"sweep_speed", speeds},
          {"sweep_lanes", lanes},
          {"ts_dt", step},
          {"model_vehicles", "linear"},
          {"beam_elements_per_span", "12"}};
}

/// Side by side and by themselves the runs have other steps: what is left of that falls with their length.
void expect_same_motion(const std::string& scene, const Values& more, const char* speeds, const char* coarse,
                        const char* fine, double bound) {
  const Values probes = more + Values{{"step_probes", "true"}};
  const ResponseExtremes alone = peaks_of(run_scene(scene, probes + sweep(speeds, "0", fine)));
  const double rough = difference(peaks_of(run_scene(scene, probes + sweep(speeds, "8", coarse))), alone);
  const double exact = difference(peaks_of(run_scene(scene, probes + sweep(speeds, "8", fine))), alone);
  testing::Test::RecordProperty(scene, text(exact));
  EXPECT_LT(exact, bound);
  EXPECT_LT(exact, 0.5 * rough);
}

TEST(CaseBatch, CoachesOverThreeSpans) {
  expect_same_motion("three_span_train",
                     {{"train_vehicles", "coach*2"}, {"scene_tail", "0"}, {"output_probes", "20,52,88"}}, "70,90,10",
                     "1e-3", "2.5e-4", 3e-4);
}

TEST(CaseBatch, OneVehicleOfManyCars) { expect_same_motion("articulated_train", {}, "60,72,4", "2e-3", "5e-4", 3e-4); }

TEST(CaseBatch, RoughTrack) {
  expect_same_motion(
      "three_span_train",
      {{"train_vehicles", "coach"}, {"scene_tail", "0.2"}, {"track_profile", "german_low"}, {"track_seed", "3"}},
      "76,84,4", "8e-4", "2e-4", 1e-3);
}

/// What bends a bridge at rest, a deck above the axis, and a linear bed.
TEST(CaseBatch, BentBridges) {
  const Values cases[] = {
      {{"beam_self_weight", "true"}},
      {{"support_settlement", "0,-0.012,0,0"}},
      {{"beam_temperature_gradient", "8"}, {"beam_temperature_depth", "1.6"}, {"beam_temperature_expansion", "1.2e-5"}},
      {{"beam_surface_height", "1.8"}},
      {{"foundation_vertical_bed_k", "1e6"}}};
  for (const Values& bent : cases) {
    SCOPED_TRACE(bent.begin()->first);
    expect_same_motion("three_span_train", bent + Values{{"train_vehicles", "coach"}, {"scene_tail", "0.1"}},
                       "76.2,84,7.8", "8e-4", "2e-4", 2e-3);
  }
}

/// A track beside the axis: the beam twists, also with warping, and with a deck above the axis.
TEST(CaseBatch, TrackBesideTheAxis) {
  const Values twisting = {{"beam_GJ", "4e10"},         {"beam_polar_inertia", "8e4"}, {"track_eccentricity", "2.3"},
                           {"train_vehicles", "coach"}, {"output_probes", "20,52,88"}, {"scene_tail", "0.1"}};
  for (const Values& more : {Values{}, Values{{"beam_ECw", "5e12"}}, Values{{"beam_surface_height", "1.8"}}})
    expect_same_motion("three_span_train", twisting + more, "76.2,84,7.8", "8e-4", "2e-4", 2e-3);
}

// Rail, sleepers and ballast carry the wheels; a long track, of which a window is solved anew from pass to pass.
TEST(CaseBatch, LayeredTrack) { expect_same_motion("r8_ballasted_bridge", {}, "60,66,3", "2e-3", "5e-4", 1e-4); }

/// A method of one solve a step: of second order.
TEST(CaseBatch, OneSolveAStep) {
  const Values scene = {{"train_vehicles", "coach"}, {"scene_tail", "0.1"}, {"step_probes", "true"}};
  const ResponseExtremes exact = peaks_of(run_scene("three_span_train", scene + sweep("76,84,8", "8", "5e-5")));
  const Values single = scene + Values{{"ts_type", "genalpha"}};
  std::vector<double> errors;
  for (const char* step : {"4e-4", "1e-4"})
    errors.push_back(difference(peaks_of(run_scene("three_span_train", single + sweep("76,84,8", "8", step))), exact,
                                "greatest_wheel_force"));
  RecordProperty("error", text(errors[1]));
  EXPECT_LT(errors[1], 3e-4);
  EXPECT_LT(errors[1], 0.25 * errors[0]);
}

TEST(CaseBatch, NeighboursAndWidthsChangeNothing) {
  const Values scene = {{"train_vehicles", "coach*2"}, {"scene_tail", "0.1"}};
  const auto run = [&](const char* speeds, const char* lanes) {
    return peaks_of(run_scene("three_span_train", scene + sweep(speeds, lanes, "1e-3")));
  };
  const ResponseExtremes eight = run("77,84,1", "8");
  EXPECT_LT(difference(run("77,84,1", "4"), eight), 1e-12);
  EXPECT_LT(difference(run("77,84,1", "1"), eight), 1e-12);
  const ResponseExtremes others = run("79,83,4", "8");  // two of them beside each other
  for (const char* name : peaks) {
    const std::size_t probes = others.at(name).size() / 2;
    for (std::size_t p = 0; p < probes; ++p) {
      EXPECT_NEAR(others.at(name)[p], eight.at(name)[2 * probes + p], 1e-12 * std::abs(others.at(name)[p])) << name;
      EXPECT_NEAR(others.at(name)[probes + p], eight.at(name)[6 * probes + p], 1e-12 * std::abs(others.at(name)[p]))
          << name;
    }
  }
}

// Over a bump that is too sharp for the fast ones wheels fly: that is a part of their motion, beside others too.
TEST(CaseBatch, RunsThatLoseContactStay) {
  const Values bump = {{"train_vehicles", "coach"}, {"scene_tail", "0.1"},      {"track_profile", "bump"},
                       {"track_bump_start", "20"},  {"track_bump_length", "2"}, {"track_bump_height", "4e-3"},
                       {"step_probes", "true"}};
  Results alone = run_scene("three_span_train", bump + sweep("20,60,20", "0", "2.5e-4"));
  Results beside = run_scene("three_span_train", bump + sweep("20,60,20", "8", "2.5e-4"));
  const std::vector<double> losses = alone("/sweep/contact_losses"), longest = alone("/sweep/longest_loss");
  EXPECT_EQ(losses.front(), 0.0);
  EXPECT_GT(losses.back(), 0.0);
  EXPECT_EQ(beside("/sweep/contact_losses"), losses);
  for (std::size_t i = 0; i < longest.size(); ++i)
    EXPECT_NEAR(beside("/sweep/longest_loss")[i], longest[i], 5e-4) << "two steps";
  EXPECT_LT(difference(peaks_of(std::move(beside)), peaks_of(std::move(alone))), 1e-3);
}

// Everything is left open: what is chosen keeps to the accuracy, by elements and with the mechanisms.
TEST(CaseBatch, ChosenByTheAccuracy) {
  const Values scene = {{"train_vehicles", "coach*2"}, {"scene_tail", "0.2"}, {"sweep_speed", "60,84,8"}};
  Results chosen = run_scene("fifty_metre_train", scene + Values{{"accuracy", "5e-3"}});
  EXPECT_GT(chosen.attribute("/sweep", "elements_per_span"), 3.0);
  EXPECT_EQ(chosen("/sweep/promised"), std::vector<double>(4, 1.0)) << "no wheel loses contact";
  const ResponseExtremes exact =
      peaks_of(run_scene("fifty_metre_train", scene + Values{{"ts_dt", "1.5e-4"},
                                                             {"beam_elements_per_span", "48"},
                                                             {"model_vehicles", "full"},
                                                             {"step_probes", "true"}}));
  const double error = difference(peaks_of(std::move(chosen)), exact);
  RecordProperty("error", text(error));
  EXPECT_LT(error, 5e-3);
}

}  // namespace
}  // namespace traverse::test
