// Vehicles, which ranks share, on one rank and on all: the same results (support/same_on_ranks.hpp).
#include <gtest/gtest.h>

#include "support/curve.hpp"
#include "support/same_on_ranks.hpp"

namespace traverse::test {
namespace {

// A flat on one wheel, a polygon on the other, over a bump that is sharper than the wheels.
// Until all of its cars are on the bridge: before, their accelerations are rounding.
TEST(Ranks, ArticulatedTrain) {
  expect_same_on_all_ranks("articulated_train",
                           {{"ts_max_time", "1.9"}, {"ts_dt", "4e-3"}, {"output_interval", "0.05"}}, 60, 1e-8);
}

TEST(Ranks, ContactLossAndImpacts) {
  expect_same_on_all_ranks("wheel_over_a_bump", {{"ts_max_time", "0.6"}}, 20, 1e-7);
}

TEST(Ranks, WheelsOutOfRoundOverASharpBump) {
  expect_same_on_all_ranks("three_span_half_car",
                           {{"train_vehicles", "half_car"},
                            {"train_positions", "5"},
                            {"ts_dt", "5e-4"},
                            {"ts_max_time", "0.6"},
                            {"output_interval", "0.02"},
                            {"vehicle_half_car_front_wheel_flat_length", "0.05"},
                            {"vehicle_half_car_rear_wheel_polygon_order", "5"},
                            {"vehicle_half_car_rear_wheel_polygon_amplitude", "1e-4"},
                            {"track_profile", "bump"},
                            {"track_bump_start", "15"},
                            {"track_bump_length", "0.2"},
                            {"track_bump_height", "0.008"}},
                           35, 1e-7);
}

// Two coaches over spans of their own.
TEST(Ranks, TrainOverIsolatedSpans) {
  expect_same_on_all_ranks("three_span_train",
                           {{"train_vehicles", "coach*2"},
                            {"beam_continuity", "simply_supported"},
                            {"beam_elements_per_span", "6"},
                            {"ts_dt", "4e-3"},
                            {"ts_max_time", "1.2"},
                            {"output_interval", "0.04"}},
                           40);
}

// Vehicles are shared: a wheel of one rubs, and they come onto the bridge one after the other.
const Values five_half_cars = {{"train_vehicles", "half_car*5"},
                               {"train_positions", "5"},
                               {"train_spacing", "9.5"},
                               {"ts_dt", "2e-3"},
                               {"ts_max_time", "1.0"},
                               {"output_interval", "0.02"},
                               {"vehicle_half_car_rear_wheel_friction", "0.2"},
                               {"vehicle_half_car_front_wheel_damping", "1e4"}};

Values with(Values options, const Values& more) {
  options.insert(options.end(), more.begin(), more.end());
  return options;
}

TEST(Ranks, SharedVehiclesWithFriction) { expect_same_on_all_ranks("three_span_half_car", five_half_cars, 100); }

TEST(Ranks, SharedVehiclesInSteppingOfOneStage) {
  expect_same_on_all_ranks("three_span_half_car", with(five_half_cars, {{"ts_type", "genalpha"}}), 100);
}

TEST(Ranks, MoreRanksThanVehicles) {
  expect_same_on_all_ranks("three_span_half_car", with(five_half_cars, {{"train_vehicles", "half_car*2"}}), 50);
}

// Friction and a free drive: they drift apart, and wheels turn.
TEST(Ranks, SharedVehiclesThatRollFreely) {
  expect_same_on_all_ranks("three_span_half_car", with(five_half_cars, {{"train_drive", "free"}}), 100);
}

// Wheels jump: all ranks have to find the same instants, whether the elements bend under wheels or not.
TEST(Ranks, SharedVehiclesThatLoseContact) {
  for (const char* seats : {"false", "true"})
    expect_same_on_all_ranks("three_span_half_car",
                             with(five_half_cars, {{"vehicle_half_car_rear_wheel_friction", "0"},
                                                   {"contact_seats", seats},
                                                   {"ts_dt", "1e-3"},
                                                   {"track_profile", "bump"},
                                                   {"track_bump_start", "20"},
                                                   {"track_bump_length", "1.0"},
                                                   {"track_bump_height", "0.02"}}),
                             100, 1e-7);
}

// Units of several vehicles that couplers join, beside some that stand alone.
TEST(Ranks, SharedVehiclesPartlyCoupled) {
  expect_same_on_all_ranks("three_span_half_car",
                           with(five_half_cars, {{"train_couplers", "bar"},
                                                 {"train_bar_bodies", "car,car"},
                                                 {"train_bar_after", "0,3"},
                                                 {"train_bar_from", "-4.0,1.5"},
                                                 {"train_bar_to", "4.0,1.5"},
                                                 {"train_bar_stiffness", "1e6"},
                                                 {"train_bar_damping", "1e4"}}),
                           100);
}

// Displacements from the start are differences of coordinates: wheelsets' accelerations on stiff contacts show it.
TEST(Ranks, LinearVehicles) {
  expect_same_on_all_ranks("three_span_train",
                           {{"train_vehicles", "coach*3"},
                            {"beam_elements_per_span", "10"},
                            {"model_vehicles", "linear"},
                            {"ts_dt", "2e-3"},
                            {"ts_max_time", "1.2"},
                            {"output_interval", "0.02"}},
                           35, 1e-8);
}

}  // namespace
}  // namespace traverse::test
