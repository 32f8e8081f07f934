// Vehicles with constant matrices (model_vehicles linear) against the mechanisms that they are.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

const Values linear = {{"model_vehicles", "linear"}}, mechanisms = {{"model_vehicles", "full"}};

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// What linear vehicles neglect, relative to the peaks, and the energy balance of their run.
void expect_close(const std::string& name, Results& run, Results& full, const Values& bounds) {
  for (const auto& [curve, bound] : bounds) {
    const double difference = relative_difference(run(curve), full(curve));
    testing::Test::RecordProperty(name + curve, text(difference));
    EXPECT_LT(difference, std::stod(bound)) << name << curve;
  }
  EXPECT_LT(energy_error(run), 1.1 * energy_error(full) + 1e-9) << name;
  EXPECT_GT(run.attribute("/summary", "linear_defect"), 0.0) << name;
}

/// A train over a bridge both ways.
void expect_close(const std::string& scene, const Values& options, const Values& bounds) {
  Results full = run_scene(scene, options + mechanisms);
  Results run = run_scene(scene, options + linear);
  expect_close(scene, run, full, bounds);
}

TEST(LinearVehicle, CoachesOverThreeSpans) {
  expect_close("three_span_train",
               {{"train_vehicles", "coach*2"},
                {"beam_elements_per_span", "8"},
                {"ts_dt", "5e-4"},
                {"ts_max_time", "2.2"},
                {"output_interval", "5e-3"}},
               {{"/probes/deflection", "1e-5"},
                {"/probes/acceleration", "1e-4"},
                {"/vehicles/0/wheel_1/normal_force", "1e-5"},
                {"/vehicles/1/car/position", "1e-9"}});
}

// One mechanism of hinged cars.
TEST(LinearVehicle, ArticulatedTrain) {
  expect_close("articulated_train", {{"ts_dt", "1e-3"}, {"ts_max_time", "1.5"}},
               {{"/probes/deflection", "1e-6"}, {"/vehicles/2/wheel_1/normal_force", "1e-6"}});
}

// Free along the track, with moments on the wheelsets and friction under the wheels.
TEST(LinearVehicle, BrakingTrain) {
  expect_close("braking_train", {{"ts_dt", "1e-3"}, {"ts_max_time", "2"}},
               {{"/probes/deflection", "1e-3"}, {"/vehicles/1/front_wheel/normal_force", "1e-3"}});
}

// A vehicle whose bodies only move up and down is linear: contact is lost and gained at the same times.
TEST(LinearVehicle, LosesContactAndGainsItAgain) {
  Results full = run_scene("wheel_over_a_bump", mechanisms);
  Results run = run_scene("wheel_over_a_bump", linear);
  EXPECT_GT(full.attribute("/summary", "contact_losses"), 3.0);
  EXPECT_EQ(run.attribute("/summary", "contact_losses"), full.attribute("/summary", "contact_losses"));
  EXPECT_LT(relative_difference(run("/separations/start"), full("/separations/start")), 1e-9);
  EXPECT_LT(relative_difference(run("/vehicles/0/wheel/normal_force"), full("/vehicles/0/wheel/normal_force")), 1e-9);
}

// What is left out are squares: over a bump of half the height it is a quarter.
TEST(LinearVehicle, LeavesOutSquares) {
  const auto scene = [](const char* height) {
    return std::string("track: {profile: bump, bump_start: 20, bump_length: 6, bump_height: ") + height +
           "}\ntrain: {vehicles: coach, positions: 0, speed: 40}\nts: {dt: 1e-3, max_time: 1.2}\n"
           "vehicle: {coach: {file: " +
           source_folder() + "/options/vehicles/velaro.yml}}\n";
  };
  std::array<double, 2> left_out{}, defect{};
  int i = 0;
  for (const char* height : {"0.02", "0.01"}) {
    Results full = run_yaml(scene(height), mechanisms);
    Results run = run_yaml(scene(height), linear);
    left_out[i] = largest_difference(run("/vehicles/0/car/acceleration"), full("/vehicles/0/car/acceleration"));
    defect[i++] = run.attribute("/summary", "linear_defect");
  }
  testing::Test::RecordProperty("ratio", text(left_out[0] / left_out[1]));
  EXPECT_NEAR(left_out[0] / left_out[1], 4.0, 0.6);
  EXPECT_NEAR(defect[0] / defect[1], 4.0, 0.6);
}

/// A coach over a bridge, and then over a bump on the ground behind it, higher than trial runs see.
std::string bridge_and_bump(const char* height) {
  return std::string(
             "beam: {spans: 25, EI: 2e10, mass: 1e4, damping_ratios: 0.01}\nmodel: {axial: false}\n"
             "train: {vehicles: coach, positions: -15, speed: 60}\naccuracy: 1e-2\nts: {max_time: 3}\n"
             "track: {profile: bump, bump_start: 90, bump_length: 6, bump_height: ") +
         height + "}\nvehicle: {coach: {file: " + source_folder() + "/options/vehicles/velaro.yml}}\n";
}

// Out of balance by more than a tenth of the accuracy as its wheels jerk where the bridge's own weight has bent it, and
// yet with the mechanisms' peaks, as one trial run with these shows.
TEST(LinearVehicle, IsKeptWhereWhatItNeglectsChangesNoPeak) {
  const Values bent = {{"train_vehicles", "coach"}, {"beam_self_weight", "true"}, {"scene_tail", "0.1"}};
  Results chosen = run_scene("three_span_train", bent + Values{{"accuracy", "1e-3"}, {"accuracy_cache", "false"}});
  const double defect = chosen.attribute("/summary", "linear_defect");
  RecordProperty("defect", text(defect));
  EXPECT_GT(defect, 1e-4);
  const Values same = {{"beam_elements_per_span", "32"}, {"ts_dt", "5e-4"}, {"step_probes", "true"}};
  Results matrices = run_scene("three_span_train", bent + same + Values{{"model_vehicles", "linear"}});
  Results full = run_scene("three_span_train", bent + same + Values{{"model_vehicles", "full"}});
  for (const char* peak : {"deflection", "acceleration", "moment", "least_wheel_force", "greatest_wheel_force"}) {
    const double off = matrices.attribute("/summary", peak) / full.attribute("/summary", peak) - 1.0;
    RecordProperty(peak, text(off));
    EXPECT_LT(std::abs(off), 1e-4) << peak;
    EXPECT_NE(off, 0.0) << "both are the same run";
  }
}

// The trial runs that compare it with mechanisms resolve the waves of the track.
TEST(LinearVehicle, IsTriedOnARoughTrack) {
  Results run = run_scene("three_span_train", {{"train_vehicles", "coach"},
                                               {"track_profile", "german_low"},
                                               {"track_wavelengths", "2,80"},
                                               {"accuracy_cache", "false"}});
  EXPECT_GT(run.attribute("/summary", "linear_defect"), 0.0);
  EXPECT_LT(run.attribute("/summary", "expected_error_wheel_force"), 1e-3);
}

// Taken where the trial runs find that it serves; repeated with the mechanism where the run shows that it did not.
TEST(LinearVehicle, AsTheAccuracyAllows) {
  const Values open = {{"model_vehicles", "auto"}};
  Results low = run_yaml(bridge_and_bump("1e-4"), open);
  EXPECT_GT(low.attribute("/summary", "linear_defect"), 0.0);
  EXPECT_LT(low.attribute("/summary", "linear_defect"), 1e-3);
  Results high = run_yaml(bridge_and_bump("0.03"), open);
  Results full = run_yaml(bridge_and_bump("0.03"));
  EXPECT_TRUE(std::isnan(high.attribute("/summary", "linear_defect")));
  const double difference = relative_difference(high("/vehicles/0/car/position"), full("/vehicles/0/car/position"));
  EXPECT_EQ(difference, 0.0);
}

/// A car on two axles in vertical guides, on rigid ground.
std::string guided_car(const char* law) {
  return std::string(R"(
vehicle:
  car:
    bodies: [frame, front_axle, rear_axle]
    joints: [front_guide, rear_guide]
    springs: [front_spring, rear_spring]
    wheels: [front_wheel, rear_wheel]
    frame: {mass: 9000.0, inertia: 8.0e4, position: [0.0, 1.5]}
    front_axle: {mass: 1500.0, inertia: 100.0, position: [2.0, 0.5]}
    rear_axle: {mass: 1500.0, inertia: 100.0, position: [-2.0, 0.5]}
    front_guide: {type: prismatic, bodies: [frame, front_axle], point: [2.0, 1.0], axis: [0.0, 1.0]}
    rear_guide: {type: prismatic, bodies: [frame, rear_axle], point: [-2.0, 1.0], axis: [0.0, 1.0]}
    front_spring: {bodies: [frame, front_axle], from: [2.0, 1.5], to: [2.0, 0.5], stiffness: 2.0e6, damping: 1.0e5}
    rear_spring: {bodies: [frame, rear_axle], from: [-2.0, 1.5], to: [-2.0, 0.5], stiffness: 2.0e6, damping: 1.0e5}
    front_wheel: {body: front_axle, radius: 0.5, law: )") +
         law + "}\n    rear_wheel: {body: rear_axle, radius: 0.5, law: " + law + R"(}
train: {vehicles: car}
ts: {dt: 1.0e-2, max_time: 4.0}
output: {interval: 0.01}
)";
}

// The drive holds the frame at its centre, and the guides hold back the axles d below it: their inertia forces m a have
// the moment 2 m a d, which the wheels' forces balance at their distance 2 l. The springs of the axles and of the
// contacts then allow the pitch m a d/l^2 (1/k + 1/k_c).
TEST(LinearVehicle, PitchOfABrakedCar) {
  const TemporaryFolder folder;
  const double m = 1500.0, d = 1.0, l = 2.0, k = 2.0e6, k_c = 5.0e7;
  for (const double end : {22.0, 38.0}) {
    const std::string law = folder.write("law.csv", "0,30\n4," + text(end) + "\n");
    Results run = run_yaml(guided_car("two_sided, stiffness: 5.0e7"),
                           linear + Values{{"train_speed_file", law}, {"gravity", "0"}});
    const double a = (end - 30.0) / 4.0, pitch = -m * a * d / (l * l) * (1.0 / k + 1.0 / k_c);
    const double found = run.column("/vehicles/0/frame/position", 2).back();
    RecordProperty("pitch_to_" + text(end), text(std::abs(found / pitch - 1.0)));
    EXPECT_NEAR(found / pitch, 1.0, 1e-7);
    EXPECT_NEAR(run("/vehicles/0/front_wheel/normal_force").back() / (m * a * d / l), 1.0, 1e-7);
    const std::vector<double> x = run.column("/vehicles/0/frame/position", 0);
    EXPECT_NEAR(x.back() - x.front(), 2.0 * (30.0 + end), 1e-11);
    EXPECT_NEAR(run.column("/vehicles/0/rear_axle/velocity", 0).back(), end, 1e-9);
    EXPECT_LT(energy_error(run), 1e-11);
  }
}

// At half the accelerations the neglected terms are a quarter.
TEST(LinearVehicle, LeavesOutSquaresOfAccelerations) {
  const TemporaryFolder folder;
  std::array<double, 2> left_out{}, defect{};
  int i = 0;
  for (const char* rows : {"0,0\n1,4\n2,4\n3,0\n", "0,0\n1,2\n2,2\n3,0\n"}) {
    const Values law = {{"train_speed_file", folder.write("law.csv", rows)}};
    Results full = run_yaml(guided_car("linear, stiffness: 5.0e7"), law + mechanisms);
    Results run = run_yaml(guided_car("linear, stiffness: 5.0e7"), law + linear);
    left_out[i] = largest_difference(run("/vehicles/0/front_spring/force"), full("/vehicles/0/front_spring/force"));
    defect[i++] = run.attribute("/summary", "linear_defect");
    EXPECT_LT(relative_difference(run("/energy/work"), full("/energy/work")), 1e-5);
    EXPECT_NEAR(run.column("/vehicles/0/frame/velocity", 0).back(), 0.0, 1e-9) << "it has come to rest";
  }
  testing::Test::RecordProperty("ratio", text(left_out[0] / left_out[1]));
  EXPECT_NEAR(left_out[0] / left_out[1], 4.0, 0.6);
  EXPECT_NEAR(defect[0] / defect[1], 4.0, 0.6);
}

// Wheels that roll by friction while their vehicle starts, runs and stops.
TEST(LinearVehicle, RollsAtAChangingSpeed) {
  const TemporaryFolder folder;
  std::string car = guided_car("hertz, stiffness: 1.0e10, friction: 0.3");
  for (const char* end : {"front", "rear"}) {  // the axles turn, on bars instead of guides
    const std::string axle = std::string(end) + "_axle", x = end[0] == 'f' ? "2.0" : "-2.0";
    const std::size_t at = car.find("{type: prismatic, bodies: [frame, " + axle);
    car.replace(at, car.find('\n', at) - at,
                "{type: distance, bodies: [frame, " + axle + "], from: [0.0, 0.5], to: [" + x + ", 0.5]}");
  }
  const Values law = {{"train_speed_file", folder.write("law.csv", "0,0\n1,3\n2,3\n3,0\n")}, {"ts_dt", "2e-3"}};
  Results full = run_yaml(car, law + mechanisms), run = run_yaml(car, law + linear);
  for (const char* name : {"/vehicles/0/front_wheel/friction_force", "/vehicles/0/rear_wheel/normal_force"})
    EXPECT_LT(relative_difference(run(name), full(name)), 1e-4) << name;
  const std::vector<double> turn = run.column("/vehicles/0/front_axle/position", 2);
  EXPECT_NEAR(turn.back() - turn.front(), -6.0 / 0.5, 0.02);
  EXPECT_NEAR(turn.back(), full.column("/vehicles/0/front_axle/position", 2).back(), 1e-5);
}

// Trains that brake to rest on a bridge, start from rest, and run to the left.
TEST(LinearVehicle, TrainsAtChangingSpeeds) {
  const TemporaryFolder folder;
  const std::string scene =
      "beam: {spans: [32, 40, 32], EI: 3.795e11, EA: 3.1e11, mass: 3e4, damping_ratios: 0.02, elements_per_span: 8}\n"
      "support: {types: [pinned, roller, roller, roller]}\ntrain: {vehicles: coach*2}\n"
      "ts: {dt: 5e-4, max_time: 2.2}\noutput: {interval: 5e-3}\n"
      "vehicle: {coach: {file: " +
      source_folder() + "/options/vehicles/velaro.yml}}\n";
  for (const auto& [name, rows] : {std::pair("stop", "0,2\n0.3,2\n1.8,0\n"), std::pair("start", "0,0\n2,2\n"),
                                   std::pair("left", "0,-60\n0.5,-60\n1.5,-58.5\n")}) {
    const Values law = {{"train_speed_file", folder.write("law.csv", rows)}};
    Results full = run_yaml(scene, law + mechanisms), run = run_yaml(scene, law + linear);
    expect_close(name, run, full,
                 {{"/probes/deflection", "5e-5"},
                  {"/supports/reaction", "5e-5"},
                  {"/vehicles/0/wheel_1/normal_force", "5e-5"},
                  {"/vehicles/1/car/position", "1e-6"},
                  {"/energy/work", "1e-5"}});
  }
}

// Three trains with laws of their own in the lanes of one block.
TEST(LinearVehicle, TrainsThatMeetAtChangingSpeeds) {
  const TemporaryFolder folder;
  const std::string scene =
      "beam: {spans: [25, 25], EI: 2e11, mass: 1e4, damping_ratios: 0.01, elements_per_span: 8, "
      "continuity: simply_supported}\nmodel: {axial: false}\ntrains: [up, down, through]\n"
      "up: {vehicles: coach*2}\ndown: {vehicles: coach}\nthrough: {vehicles: coach, speed: 35}\n"
      "ts: {dt: 1e-3, max_time: 2}\noutput: {interval: 0.01}\n"
      "vehicle: {coach: {file: " +
      source_folder() + "/options/vehicles/velaro.yml}}\n";
  const Values laws = {{"up_speed_file", folder.write("up.csv", "0,40\n0.5,40\n1.5,38.5\n")},
                       {"down_speed_file", folder.write("down.csv", "0,0\n1.8,-2\n")}};
  Results full = run_yaml(scene, laws + mechanisms);
  Results run = run_yaml(scene, laws);  // on separate spans vehicles are linear by default
  expect_close("three", run, full,
               {{"/probes/deflection", "1e-5"},
                {"/vehicles/0/wheel_2/normal_force", "5e-5"},
                {"/vehicles/2/wheel_1/normal_force", "5e-5"},
                {"/vehicles/3/wheel_1/normal_force", "5e-5"},
                {"/energy/work", "1e-5"}});
}

}  // namespace
}  // namespace traverse::test
