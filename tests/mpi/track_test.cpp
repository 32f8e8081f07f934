// Tracks and foundations on one rank and on all: the same results (support/same_on_ranks.hpp).
#include <gtest/gtest.h>

#include "support/curve.hpp"
#include "support/same_on_ranks.hpp"

namespace traverse::test {
namespace {

TEST(Ranks, PropWithAGap) {
  expect_same_on_all_ranks("prop_with_gap",
                           {{"beam_elements_per_span", "7"}, {"ts_dt", "2e-3"}, {"output_interval", "0.02"}}, 40);
}

// One-sided bed and points, a cubic term and a buffer, on a bridge with a joint; partly lifted off.
TEST(Ranks, FoundationsThatAreNotLinear) {
  expect_same_on_all_ranks("three_span_half_car",
                           {{"train_vehicles", "half_car"},
                            {"train_positions", "5"},
                            {"train_drive", "free"},
                            {"ts_dt", "2e-3"},
                            {"ts_max_time", "1.0"},
                            {"output_interval", "0.02"},
                            {"beam_continuity", "hinge,continuous"},
                            {"foundation_vertical_x", "12.3,25,55"},
                            {"foundation_vertical_k", "1e7,1e8,0"},
                            {"foundation_vertical_c", "1e4"},
                            {"foundation_vertical_one_sided", "true,true,false"},
                            {"foundation_vertical_cubic", "0,0,1e14"},
                            {"foundation_vertical_bed_k", "1e5"},
                            {"foundation_vertical_bed_c", "1e3"},
                            {"foundation_vertical_bed_one_sided", "true"},
                            {"foundation_longitudinal_x", "80"},
                            {"foundation_longitudinal_k", "1e8"},
                            {"foundation_longitudinal_gap", "1e-6"}},
                           35);
}

// On the bridge below a layered track. A penetration is a difference of lengths of 0.46 m: by their rounding a Hertz
// contact's force has 1e-7 N of noise, which on the 72 kg of a bay of rail is 1e-9 m/s2 of a peak of 0.06 m/s2 (ten
// times less with contacts ten times softer).
TEST(Ranks, PropBelowALayeredTrack) {
  expect_same_on_all_ranks("r8_ballasted_bridge",
                           {{"track_elements_per_bay", "1"},
                            {"ts_dt", "2e-3"},
                            {"ts_max_time", "1.5"},
                            {"output_interval", "0.02"},
                            {"foundation_vertical_x", "25"},
                            {"foundation_vertical_k", "1e8"},
                            {"foundation_vertical_gap", "1e-4"},
                            {"foundation_vertical_one_sided", "true"}},
                           20, 1e-8);
}

// Hanging, missing and weak sleepers, ballast in shear and with a mass of its own on the bridge, a joint of the rail;
// the cut between two ranks lies in the bridge. Newton's method for the gaps stops at 1e-12 of the greatest force a
// stage, in the course of which wheel forces of 1.1e5 N come to differ by 3e-5 N: on the 1,813 kg of a wheelset 1e-7 of
// its acceleration, which is 0.2 m/s2 at most.
TEST(Ranks, TrackByStretch) {
  expect_same_on_all_ranks("r8_ballasted_bridge",
                           {{"track_elements_per_bay", "2"},
                            {"ts_dt", "2e-3"},
                            {"ts_max_time", "1.2"},
                            {"output_interval", "0.02"},
                            {"output_sleepers", "-1.8,6,24,55"},
                            {"track_shear_k", "7.84e7"},
                            {"track_shear_c", "8e4"},
                            {"track_ballast_own_mass", "true"},
                            {"track_rail_hinges", "12"},
                            {"track_stretches", "hung,weak,gone"},
                            {"track_hung_from", "-3"},
                            {"track_hung_to", "30"},
                            {"track_hung_gap", "2e-4"},
                            {"track_weak_from", "5.4"},
                            {"track_weak_to", "20.4"},
                            {"track_weak_pad_k", "2e7"},
                            {"track_weak_gap", "0"},
                            {"track_gone_from", "9"},
                            {"track_gone_to", "9"},
                            {"track_gone_sleepers", "none"}},
                           20, 1e-6);
}

// A braked wagon that rolls freely; the deck is warm, and sleepers slide on either side of the cut.
TEST(Ranks, SleepersThatSlide) {
  expect_same_on_all_ranks("braking_on_ballast",
                           {{"train_vehicles", "wagon"},
                            {"track_approach", "60"},
                            {"ts_dt", "2e-3"},
                            {"ts_max_time", "0.4"},
                            {"output_interval", "0.02"}},
                           20, 1e-6);
}

// The deck is warm, its movable bearing slides, and the rail has a device on it and one beside it.
TEST(Ranks, ExpansionDeviceAndABearingThatSlides) {
  expect_same_on_all_ranks("braking_on_ballast",
                           {{"train_vehicles", "wagon"},
                            {"track_approach", "60"},
                            {"track_rail_expansion_devices", "30.3,60.3"},
                            {"foundation_longitudinal_x", "0,60"},
                            {"foundation_longitudinal_c", "0"},
                            {"foundation_longitudinal_k", "6e8,1e8"},
                            {"foundation_longitudinal_limit", "0,5e4"},
                            {"ts_dt", "2e-3"},
                            {"ts_max_time", "0.4"},
                            {"output_interval", "0.02"}},
                           22, 1e-6);
}

// Each rank knows the contacts of its own vehicles only. Accelerations of the rail differ as the wheel forces do.
TEST(Ranks, ContactPointsOnTheRail) {
  expect_same_on_all_ranks("r8_ballasted_bridge",
                           {{"train_vehicles", "coach*2"},
                            {"train_positions", "-15,-40"},
                            {"track_profile", "german_low"},
                            {"track_elements_per_bay", "2"},
                            {"model_vehicles", "full"},
                            {"output_contact_points", "true"},
                            {"output_rail", "-20,60"},
                            {"ts_dt", "5e-4"},
                            {"ts_max_time", "0.2"},
                            {"output_interval", "0.01"}},
                           40, 1e-6);
}

}  // namespace
}  // namespace traverse::test
