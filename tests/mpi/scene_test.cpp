// A scene gives the same results on one rank and on all: each rank also runs it on its own and compares with the
// file of the common run.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <petscsys.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"

namespace traverse::test {
namespace {

// Names of all datasets of numbers.
std::vector<std::string> datasets(const std::string& path) {
  std::vector<std::string> names;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  auto visit = [](hid_t root, const char* name, const auto* info,
                  void* into) -> herr_t {  // H5O_info_t changes with HDF5
    if (info->type != H5O_TYPE_DATASET) return 0;
    const hid_t set = H5Dopen2(root, name, H5P_DEFAULT);
    const hid_t type = H5Dget_type(set);
    if (H5Tget_class(type) == H5T_FLOAT)
      static_cast<std::vector<std::string>*>(into)->push_back(std::string("/") + name);
    H5Tclose(type);
    H5Dclose(set);
    return 0;
  };
  H5Ovisit1(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &names);
  H5Fclose(file);
  return names;
}

// A mode's sign is free: the largest ordinate counts as positive.
std::vector<double> with_sign(std::vector<double> shapes, std::size_t modes) {
  const std::size_t nodes = shapes.size() / modes;
  for (std::size_t m = 0; m < modes; ++m) {
    const auto begin = shapes.begin() + static_cast<std::ptrdiff_t>(m * nodes);
    const auto end = begin + static_cast<std::ptrdiff_t>(nodes);
    double first = 0.0, largest = 0.0;
    for (auto it = begin; it != end; ++it) largest = std::max(largest, std::abs(*it));
    for (auto it = begin; it != end && first == 0.0; ++it) {
      if (std::abs(*it) > 0.1 * largest) first = *it;
    }
    if (first < 0.0) std::transform(begin, end, begin, [](double x) { return -x; });
  }
  return shapes;
}

/// A dataset; where it is one of the end of the run, after the series that it continues, whose peak it is measured by.
std::vector<double> with_series(Results& run, const std::string& name) {
  if (!name.starts_with("/end/")) return run(name);
  std::vector<double> all = run(name.substr(4));
  const std::vector<double>& end = run(name);
  all.insert(all.end(), end.begin(), end.end());
  return all;
}

// To `bound` of each dataset's peak; what is left of the energy balance is rounding.
// Accelerations below `at_rest` (m/s2) are rounding too.
void expect_same(Results& one, Results& all, std::size_t least, double at_rest = 0.0, double bound = 1e-9) {
  const std::vector<std::string> names = datasets(one.file());
  EXPECT_EQ(names, datasets(all.file()));
  EXPECT_GE(names.size(), least);
  for (const std::string& name : names) {
    if (name.ends_with("residual")) continue;
    const std::size_t modes = name == "/modes/shape" ? one("/modes/frequency").size() : 0;
    const std::vector<double> a = modes > 0 ? with_sign(all(name), modes) : with_series(all, name);
    const std::vector<double> b = modes > 0 ? with_sign(one(name), modes) : with_series(one, name);
    ASSERT_EQ(a.size(), b.size()) << name;
    if (name.ends_with("/balance/inertia") && at_rest > 0.0) continue;
    if (name.ends_with("acceleration") && at_rest > 0.0) {
      EXPECT_LT(std::max(std::abs(peak(a).first), std::abs(peak(b).first)), at_rest) << name;
      continue;
    }
    EXPECT_LT(relative_difference(a, b), bound) << name;
  }
}

void expect_same_on_all_ranks(const std::string& scene, const Values& options, std::size_t least, double bound = 1e-9) {
  Results all = run_scene(scene, options, PETSC_COMM_WORLD);
  Results one = run_scene(scene, options, PETSC_COMM_SELF);
  expect_same(one, all, least, 0.0, bound);
}

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

// A flat on one wheel, a polygon on the other, over a bump that is sharper than the wheels.
// Until all of its cars are on the bridge: before, their accelerations are rounding.
TEST(Ranks, ArticulatedTrain) {
  expect_same_on_all_ranks("articulated_train",
                           {{"ts_max_time", "1.9"}, {"ts_dt", "4e-3"}, {"output_interval", "0.05"}}, 60, 1e-8);
}

TEST(Ranks, ContactLossAndImpacts) {
  expect_same_on_all_ranks("wheel_over_a_bump", {{"ts_max_time", "0.6"}}, 20, 1e-7);
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

// Wheels jump: all ranks have to find the same instants.
TEST(Ranks, SharedVehiclesThatLoseContact) {
  expect_same_on_all_ranks("three_span_half_car",
                           with(five_half_cars, {{"vehicle_half_car_rear_wheel_friction", "0"},
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
                           35);
  expect_same_on_all_ranks(
      "r6_three_spans",
      damped + Values{{"load_forces", "1e4,2e4,-5e3"}, {"load_positions", "0,-7.3,-21"}, {"scene_tail", "0.3"}}, 12);
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

TEST(Ranks, MovingForces) {
  expect_same_on_all_ranks("r6_three_spans",
                           {{"load_forces", "1e4,2e4,-5e3"},
                            {"load_positions", "0,-7.3,-21"},
                            {"beam_elements_per_span", "7,3,11"},
                            {"beam_damping_ratios", "0.01,0.02"},
                            {"ts_dt", "2e-3"},
                            {"scene_tail", "0.3"},
                            {"output_interval", "0.02"}},
                           12);
}

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

TEST(Ranks, ExplicitContact) {
  expect_same_on_all_ranks("r4_hertz_wheel",
                           {{"beam_elements_per_span", "5"},
                            {"ts_arkimex_fully_implicit", "false"},
                            {"ts_dt", "1e-3"},
                            {"output_interval", "0.02"}},
                           20);
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
                            {"beam_damping_ratios", "0.01,0.02"},
                            {"beam_elements_per_span", "8"}},
                           3);
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
