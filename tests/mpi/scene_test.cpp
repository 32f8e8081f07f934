// Scenes on one rank and on all: the same results (support/same_on_ranks.hpp).
#include <gtest/gtest.h>
#include <petscsys.h>

#include "support/curve.hpp"
#include "support/same_on_ranks.hpp"

namespace traverse::test {
namespace {

TEST(Ranks, HalfCarWithFrictionOnThreeSpans) {
  expect_same_on_all_ranks("three_span_half_car",
                           {{"train_vehicles", "half_car"},
                            {"train_positions", "-5"},
                            {"ts_dt", "2e-3"},
                            {"output_interval", "0.02"},
                            {"ts_max_time", "1.6"},
                            {"vehicle_half_car_rear_wheel_friction", "0.2"},
                            {"vehicle_half_car_front_wheel_damping", "1e4"}},
                           35);
}

TEST(Ranks, FreeTrainOnABridgeWithFoundationAndBump) {
  expect_same_on_all_ranks("three_span_half_car",
                           {{"train_vehicles", "half_car"},
                            {"train_positions", "5"},
                            {"train_drive", "free"},
                            {"ts_dt", "2e-3"},
                            {"ts_max_time", "1.0"},
                            {"output_interval", "0.02"},
                            {"beam_self_weight", "true"},
                            {"foundation_vertical_x", "12.3,55"},
                            {"foundation_vertical_k", "1e7"},
                            {"foundation_vertical_c", "1e4"},
                            {"foundation_longitudinal_bed_k", "1e5"},
                            {"track_profile", "bump"},
                            {"track_bump_start", "20"},
                            {"track_bump_length", "3"},
                            {"track_bump_height", "0.003"}},
                           35);
}

// Settled and scoured supports, a crack, a warm deck; shear, with a crack that is a spring.
TEST(Ranks, BridgesAsFoundAndThatShear) {
  const Values short_run = {{"ts_dt", "2e-3"}, {"ts_max_time", "0.5"}, {"output_interval", "0.02"}};
  expect_same_on_all_ranks("bridge_as_found", short_run + Values{{"beam_elements_per_span", "10"}}, 30, 1e-8);
  expect_same_on_all_ranks(
      "deep_short_span",
      short_run + Values{{"beam_elements_per_span", "12"}, {"beam_cracks_x", "4.1"}, {"beam_cracks_k", "2e9"}}, 30,
      1e-8);
}

// All ranks judge the steps alike.
TEST(Ranks, StepsChosenByTheirErrors) {
  const Values ladder = {{"ts_adapt_type", "ladder"}, {"ts_dt", "8e-3"}};
  expect_same_on_all_ranks("wheel_over_a_bump", ladder + Values{{"ts_max_time", "0.6"}, {"output_interval", "8e-3"}},
                           20, 1e-7);
  expect_same_on_all_ranks("three_span_train",
                           ladder + Values{{"train_vehicles", "coach*2"},
                                           {"ts_max_time", "1"},
                                           {"beam_elements_per_span", "10"},
                                           {"output_interval", "0.02"}},
                           35, 1e-7);
}

TEST(Ranks, TrainOnABridgeByItsModes) {
  expect_same_on_all_ranks("three_span_train",
                           {{"train_vehicles", "coach*3"},
                            {"beam_elements_per_span", "10"},
                            {"beam_self_weight", "true"},
                            {"model_modes", "12"},
                            {"ts_dt", "2e-3"},
                            {"ts_max_time", "1.2"},
                            {"output_interval", "0.02"}},
                           35);
}

TEST(Ranks, ABridgeWhoseModesAreCoupled) {
  const Values damped = {{"foundation_vertical_x", "16,52"},   {"foundation_vertical_k", "0,1e8"},
                         {"foundation_vertical_c", "3e6,2e6"}, {"beam_elements_per_span", "10"},
                         {"beam_damping_ratios", "0.01"},      {"model_modes", "12"},
                         {"output_interval", "0.02"}};
  expect_same_on_all_ranks("three_span_train",
                           damped + Values{{"train_vehicles", "coach*3"}, {"ts_dt", "2e-3"}, {"ts_max_time", "1.2"}},
                           35, 1e-8);  // 1e-10 of a coach's weight may be left in a force: 3e-8 m/s2 of a wheelset
  expect_same_on_all_ranks(
      "r6_three_spans",
      damped + Values{{"load_forces", "1e4,2e4,-5e3"}, {"load_positions", "0,-7.3,-21"}, {"scene_tail", "0.3"}}, 12);
}

TEST(Ranks, MovingForces) {
  expect_same_on_all_ranks("r6_three_spans",
                           {{"load_forces", "1e4,2e4,-5e3"},
                            {"load_positions", "0,-7.3,-21"},
                            {"beam_elements_per_span", "7,3,11"},
                            {"beam_damping_ratios", "0.01,0.011"},
                            {"ts_dt", "2e-3"},
                            {"scene_tail", "0.3"},
                            {"output_interval", "0.02"}},
                           12);
}

// At rest accelerations are rounding: they are zero on any number of ranks.
TEST(Ranks, StaticResponse) {
  const Values options = {{"scene_analysis", "static"}, {"train_positions", "33,12"}};
  Results all = run_scene("three_span_half_car", options, PETSC_COMM_WORLD);
  Results one = run_scene("three_span_half_car", options, PETSC_COMM_SELF);
  expect_same(one, all, 35, 1e-6);
}

TEST(Ranks, Modes) {
  expect_same_on_all_ranks("r6_three_spans",
                           {{"scene_analysis", "modes"},
                            {"modes_count", "8"},
                            {"beam_spans", "20,23,17"},
                            {"beam_damping_ratios", "0.01,0.011"},
                            {"beam_elements_per_span", "8"}},
                           3);
}

// A train on one track of three spans that twist, by elements and by modes, and two trains on two tracks.
TEST(Ranks, BridgesThatTwist) {
  const Values twisting = {{"beam_spans", "25,27,23"},
                           {"beam_GJ", "1.1e10"},
                           {"beam_polar_inertia", "4e4"},
                           {"track_eccentricity", "2.25"},
                           {"ts_dt", "2e-3"},
                           {"output_interval", "0.02"},
                           {"ts_max_time", "0.8"},
                           {"train_vehicles", "half_car"},
                           {"train_positions", "-5"},
                           {"beam_elements_per_span", "10"}};
  expect_same_on_all_ranks("three_span_half_car", twisting, 35);
  expect_same_on_all_ranks("three_span_half_car", twisting + Values{{"model_modes", "12"}}, 35);
  expect_same_on_all_ranks("two_tracks",
                           {{"up_vehicles", "coach"},
                            {"down_vehicles", "coach"},
                            {"ts_dt", "2e-3"},
                            {"output_interval", "0.02"},
                            {"ts_max_time", "0.6"}},
                           35);
}

// One element: fewer nodes than ranks.
TEST(Ranks, MoreRanksThanNodes) {
  expect_same_on_all_ranks("r2_sprung_mass",
                           {{"beam_elements_per_span", "1"},
                            {"ts_dt", "2e-3"},
                            {"output_interval", "0.02"},
                            {"support_types", "clamped,roller"}},
                           18);
}

}  // namespace
}  // namespace traverse::test
