// Vehicles joined by couplers against the same bodies written as one vehicle, and against statics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/curve.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

// A car on a bogie of its own in front, and behind on one that it shares with the next car.
const char* const scene = R"(
beam: {spans: [30.0, 30.0], EI: 2.0e10, mass: 12000.0, elements_per_span: 6, damping_ratios: [0.02, 0.02]}
support: {types: [pinned, roller, roller]}
scene: {tail: 0.1}
ts: {dt: 0.002}
output: {interval: 0.02}
)";

const char* const two_vehicles = R"(
vehicle:
  head:
    bodies: [car, front, shared]
    joints: [front_guide, shared_guide]
    springs: [front_spring, shared_spring]
    wheels: [wheel_1, wheel_2]
    car:    {mass: 20000.0, inertia: 4.0e5, position: [0.0, 2.0]}
    front:  {mass: 4000.0, inertia: 1000.0, position: [7.0, 0.5]}
    shared: {mass: 4500.0, inertia: 1000.0, position: [-7.0, 0.5]}
    front_guide:   {type: prismatic, bodies: [car, front], point: [7.0, 0.5], axis: [0.0, 1.0]}
    shared_guide:  {type: prismatic, bodies: [car, shared], point: [-7.0, 0.5], axis: [0.0, 1.0]}
    front_spring:  {bodies: [car, front], from: [7.0, 1.5], to: [7.0, 0.5], stiffness: 8.0e5, damping: 3.0e4}
    shared_spring: {bodies: [car, shared], from: [-6.8, 1.5], to: [-6.8, 0.5], stiffness: 8.0e5, damping: 3.0e4}
    wheel_1: {body: front, radius: 0.5, law: hertz, stiffness: 1.0e10}
    wheel_2: {body: shared, radius: 0.5, law: hertz, stiffness: 1.0e10}
  tail:
    bodies: [car, rear]
    joints: [rear_guide]
    springs: [rear_spring]
    wheels: [wheel_3]
    car:  {mass: 18000.0, inertia: 3.5e5, position: [0.0, 2.0]}
    rear: {mass: 4000.0, inertia: 1000.0, position: [-7.0, 0.5]}
    rear_guide:  {type: prismatic, bodies: [car, rear], point: [-7.0, 0.5], axis: [0.0, 1.0]}
    rear_spring: {bodies: [car, rear], from: [-7.0, 1.5], to: [-7.0, 0.5], stiffness: 8.0e5, damping: 3.0e4}
    wheel_3: {body: rear, radius: 0.5, law: hertz, stiffness: 1.0e10}
train:
  vehicles: [head, tail]
  positions: [-7.0, -21.0]
  speed: 40.0
  couplers: [pivot, spring, buffer]
  pivot:  {type: slot, bodies: [shared, car], point: [-7.0, 0.5], axis: [0.0, 1.0]}
  spring: {bodies: [shared, car], from: [-7.2, 0.5], to: [6.8, 1.5], stiffness: 8.0e5, damping: 3.0e4}
  buffer: {bodies: [car, car], from: [-6.5, 3.0], to: [6.5, 3.0], stiffness: 1.0e5, damping: 1.0e4}
)";

const char* const one_vehicle = R"(
vehicle:
  both:
    bodies: [car, front, shared, second, rear]
    joints: [front_guide, shared_guide, rear_guide, pivot]
    springs: [front_spring, shared_spring, rear_spring, spring, buffer]
    wheels: [wheel_1, wheel_2, wheel_3]
    car:    {mass: 20000.0, inertia: 4.0e5, position: [0.0, 2.0]}
    front:  {mass: 4000.0, inertia: 1000.0, position: [7.0, 0.5]}
    shared: {mass: 4500.0, inertia: 1000.0, position: [-7.0, 0.5]}
    second: {mass: 18000.0, inertia: 3.5e5, position: [-14.0, 2.0]}
    rear:   {mass: 4000.0, inertia: 1000.0, position: [-21.0, 0.5]}
    front_guide:   {type: prismatic, bodies: [car, front], point: [7.0, 0.5], axis: [0.0, 1.0]}
    shared_guide:  {type: prismatic, bodies: [car, shared], point: [-7.0, 0.5], axis: [0.0, 1.0]}
    rear_guide:    {type: prismatic, bodies: [second, rear], point: [-21.0, 0.5], axis: [0.0, 1.0]}
    pivot:         {type: slot, bodies: [shared, second], point: [-7.0, 0.5], axis: [0.0, 1.0]}
    front_spring:  {bodies: [car, front], from: [7.0, 1.5], to: [7.0, 0.5], stiffness: 8.0e5, damping: 3.0e4}
    shared_spring: {bodies: [car, shared], from: [-6.8, 1.5], to: [-6.8, 0.5], stiffness: 8.0e5, damping: 3.0e4}
    rear_spring:   {bodies: [second, rear], from: [-21.0, 1.5], to: [-21.0, 0.5], stiffness: 8.0e5, damping: 3.0e4}
    spring: {bodies: [shared, second], from: [-7.2, 0.5], to: [-7.2, 1.5], stiffness: 8.0e5, damping: 3.0e4}
    buffer: {bodies: [car, second], from: [-6.5, 3.0], to: [-7.5, 3.0], stiffness: 1.0e5, damping: 1.0e4}
    wheel_1: {body: front, radius: 0.5, law: hertz, stiffness: 1.0e10}
    wheel_2: {body: shared, radius: 0.5, law: hertz, stiffness: 1.0e10}
    wheel_3: {body: rear, radius: 0.5, law: hertz, stiffness: 1.0e10}
train: {vehicles: both, positions: -7.0, speed: 40.0}
)";

TEST(Couplers, JoinedVehiclesAreOneMechanism) {
  Results joined = run_yaml(std::string(scene) + two_vehicles);
  Results whole = run_yaml(std::string(scene) + one_vehicle);
  const std::vector<std::pair<std::string, std::string>> same = {{"0/car/position", "0/car/position"},
                                                                 {"0/shared/acceleration", "0/shared/acceleration"},
                                                                 {"1/car/position", "0/second/position"},
                                                                 {"1/rear/acceleration", "0/rear/acceleration"},
                                                                 {"0/wheel_2/normal_force", "0/wheel_2/normal_force"},
                                                                 {"1/wheel_3/normal_force", "0/wheel_3/normal_force"},
                                                                 {"1/rear_guide/reaction", "0/rear_guide/reaction"},
                                                                 {"0/shared_spring/force", "0/shared_spring/force"}};
  double worst = 0.0;
  for (const auto& [a, b] : same) {
    const double difference = relative_difference(joined("/vehicles/" + a), whole("/vehicles/" + b));
    EXPECT_LT(difference, 1e-9) << a;
    worst = std::max(worst, difference);
  }
  const auto near = [&](const std::string& coupler, const std::vector<double>& other) {
    EXPECT_LT(relative_difference(joined("/couplers/" + coupler), other), 1e-8) << coupler;
  };
  near("spring/force", whole("/vehicles/0/spring/force"));
  near("buffer/force", whole("/vehicles/0/buffer/force"));
  near("pivot/fx", whole.column("/vehicles/0/pivot/reaction", 0));
  EXPECT_EQ(joined("/couplers/pivot/gap"), std::vector<double>{0.0});
  EXPECT_LT(relative_difference(joined("/probes/deflection"), whole("/probes/deflection")), 1e-9);
  RecordProperty("joined_against_one_vehicle", text(worst));
}

TEST(Couplers, AWeakSpringChangesNothing) {
  const Values weak = {{"train_couplers", "b"},    {"train_b_bodies", "car,car"}, {"train_b_from", "-12.6,1.6"},
                       {"train_b_to", "12.6,1.6"}, {"train_b_stiffness", "1e-6"}, {"train_vehicles", "coach*3"},
                       {"output_interval", "0.02"}};
  const Values fixed = {{"ts_dt", "2e-3"}, {"beam_elements_per_span", "10"}};
  Results joined = run_scene("three_span_train", weak + fixed);
  Results apart =
      run_scene("three_span_train", Values{{"train_vehicles", "coach*3"}, {"output_interval", "0.02"}} + fixed);
  EXPECT_LT(relative_difference(joined("/probes/deflection"), apart("/probes/deflection")), 1e-9);
  EXPECT_LT(relative_difference(joined("/vehicles/2/car/acceleration"), apart("/vehicles/2/car/acceleration")), 1e-8);
}

TEST(Couplers, ArticulatedTrainStandsOnItsBogies) {
  Results run = run_scene("articulated_train", {{"scene_analysis", "static"}});
  // a bogie between two middle cars carries one car, itself and its wheelsets
  const double axle = 0.5 * (30000.0 + 3040.0 + 2.0 * 1780.0) * 9.81;
  for (const char* wheel : {"1", "2"})
    EXPECT_NEAR(run(std::string("/vehicles/2/wheel_") + wheel + "/normal_force")[0], axle, 1e-3 * axle);
  double sum = 0.0;
  for (int k = 0; k < 6; ++k)
    for (int w = 1; w <= (k == 0 ? 4 : 2); ++w)
      sum += run("/vehicles/" + std::to_string(k) + "/wheel_" + std::to_string(w) + "/normal_force")[0];
  const double weight = (6 * 30000.0 + 7 * 3040.0 + 14 * 1780.0) * 9.81;
  EXPECT_NEAR(sum, weight, 1e-9 * weight);
}

TEST(Couplers, FreeTrainPassesItsBrakingOn) {
  // two wagons, the front one braked by 20 kN, on level ground: the coupler pushes as the rear one's mass asks
  const char* const wagons = R"(
vehicle:
  wagon:
    bodies: [car]
    actuators: [brake]
    drivers: [level]
    wheels: [front, rear]
    level: {body: car, coordinate: phi}
    car: {mass: 30000.0, inertia: 3.0e5, position: [0.0, 0.5]}
    brake: {body: car, force: [-10000.0, 0.0]}
    front: {body: car, radius: 0.5, law: linear, stiffness: 1.0e8}
    rear:  {body: car, radius: 0.5, law: linear, stiffness: 1.0e8}
  trailer:
    bodies: [car]
    drivers: [level]
    wheels: [front, rear]
    level: {body: car, coordinate: phi}
    car: {mass: 20000.0, inertia: 3.0e5, position: [0.0, 0.5]}
    front: {body: car, radius: 0.5, law: linear, stiffness: 1.0e8}
    rear:  {body: car, radius: 0.5, law: linear, stiffness: 1.0e8}
train:
  vehicles: [wagon, trailer]
  positions: [0.0, -12.0]
  speed: 20.0
  drive: free
  couplers: [gear]
  gear: {bodies: [car, car], from: [-5.0, 0.5], to: [5.0, 0.5], stiffness: 1.0e6, damping: 8.0e4}
ts: {max_time: 8.0, dt: 0.002}
output: {interval: 0.1}
)";
  Results run = run_yaml(wagons);
  const double deceleration = 10000.0 / 50000.0;
  EXPECT_NEAR(run.column("/vehicles/1/car/acceleration", 0).back(), -deceleration, 1e-6);
  EXPECT_NEAR(run("/couplers/gear/force").back(), -20000.0 * deceleration, 1.0);
  EXPECT_NEAR(run.column("/vehicles/0/car/velocity", 0).back(), 20.0 - 8.0 * deceleration, 2e-3);
}

}  // namespace
}  // namespace traverse::test
