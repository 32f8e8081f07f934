// Trains and forces in either direction, at speeds that change: mirror images, sums, statics after a stop, impulses.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/curve.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

/// A car that has all that a mirror image turns round: joints, springs, a torsion spring with an uneven table, an
/// actuator with a table, a driver, wheels out of round, a sensor.
std::string car(const TemporaryFolder& folder, bool turned) {
  const double s = turned ? -1.0 : 1.0;
  const std::string twist = folder.write(turned ? "twist_turned.csv" : "twist.csv",
                                         turned ? "-0.01,-3e4\n0,0\n0.02,2e4\n" : "-0.02,-2e4\n0,0\n0.01,3e4\n");
  const std::string push = folder.write(turned ? "push_turned.csv" : "push.csv",
                                        turned ? "0,0,0\n0.5,-500,-2000\n1,0,0\n" : "0,0,0\n0.5,500,2000\n1,0,0\n");
  const auto x = [s](double value) { return std::to_string(s * value); };
  return R"(
vehicle:
  car:
    bodies:  [frame, box, front_axle, rear_axle]
    joints:  [front_guide, rear_guide, pin]
    springs: [front_spring, rear_spring, stop]
    torsion_springs: [twist]
    actuators: [push]
    drivers: [level]
    wheels:  [front_wheel, rear_wheel]
    sensors: [seat]
    seat:       {body: box, point: [)" +
         x(1.1) + R"(, 2.7]}
    frame:      {mass: 9000.0, inertia: 8.0e4, position: [)" +
         x(0.1) + R"(, 1.5]}
    box:        {mass: 3000.0, inertia: 4.0e3, position: [)" +
         x(0.7) + R"(, 2.5]}
    front_axle: {mass: 1500.0, inertia: 100.0, position: [)" +
         x(2.0) + R"(, 0.5]}
    rear_axle:  {mass: 1000.0, inertia: 100.0, position: [)" +
         x(-2.2) + R"(, 0.5]}
    front_guide: {type: prismatic, bodies: [frame, front_axle], point: [)" +
         x(2.0) + R"(, 1.0], axis: [0.0, 1.0]}
    rear_guide:  {type: prismatic, bodies: [frame, rear_axle], point: [)" +
         x(-2.2) + R"(, 1.0], axis: [)" + x(0.1) + R"(, 1.0]}
    pin:         {type: revolute, bodies: [frame, box], point: [)" +
         x(0.4) + R"(, 1.9]}
    front_spring: {bodies: [frame, front_axle], from: [)" +
         x(2.0) + R"(, 1.5], to: [)" + x(2.0) + R"(, 0.5], stiffness: 2.47e6, damping: 3.0e4}
    rear_spring:  {bodies: [frame, rear_axle], from: [)" +
         x(-2.0) + R"(, 1.5], to: [)" + x(-2.2) + R"(, 0.5], stiffness: 4.23e6, damping: 4.0e4}
    stop:         {bodies: [frame, box], from: [)" +
         x(1.5) + R"(, 1.5], to: [)" + x(1.5) + R"(, 2.4], stiffness: 6.0e6, damping: 2.0e4}
    twist:        {bodies: [frame, box], table: )" +
         twist + R"(, damping: 500.0}
    push:         {body: box, table: )" +
         push + R"(}
    level:        {body: front_axle, coordinate: phi, value: )" +
         x(0.0) + R"(, rate: 0.0}
    front_wheel:  {body: front_axle, radius: 0.5, law: hertz, stiffness: 1.0e9, flat_length: 0.03, flat_angle: )" +
         x(0.4) + R"(}
    rear_wheel:   {body: rear_axle, radius: 0.5, law: linear, stiffness: 3.0e6, polygon_order: 3, polygon_amplitude: 1.0e-4, polygon_phase: )" +
         x(0.8) + "}\n";
}

const std::string bridge = R"(
beam: {spans: [20.0, 25.0, 20.0], EI: 8.33e9, mass: 2303.0, damping_ratios: 0.02, elements_per_span: 8}
support: {types: [pinned, roller, roller, roller]}
ts_dt: 1.0e-3
output: {interval: 0.01, probes: [9.3, 31.9, 55.7]}
)";
const Values turned_bridge = {{"support_types", "roller,roller,roller,pinned"}, {"output_probes", "9.3,33.1,55.7"}};

/// The largest differences of a scene and its mirror image, over the greatest value: of deflections and of wheel
/// forces.
struct Difference {
  double deflection = 0.0, force = 0.0;
};
Difference difference_of_mirrored(Results& one, Results& other, const std::vector<int>& vehicles) {
  Difference worst;
  for (const std::size_t p : {0, 1, 2})
    worst.deflection = std::max(worst.deflection, relative_difference(other.column("/probes/deflection", 2 - p),
                                                                      one.column("/probes/deflection", p)));
  for (std::size_t k = 0; k < vehicles.size(); ++k)
    for (const char* wheel : {"front_wheel", "rear_wheel"}) {
      const auto name = [&](int number) {
        return "/vehicles/" + std::to_string(number) + "/" + wheel + "/normal_force";
      };
      worst.force =
          std::max(worst.force, relative_difference(other(name(vehicles[k])), one(name(static_cast<int>(k)))));
    }
  return worst;
}

/// Along x and in rotation sensors see the opposite, upward the same.
void expect_mirrored_sensors(Results& one, Results& other, const std::vector<int>& vehicles) {
  for (const int vehicle : vehicles)
    for (const auto& [name, sign] :
         {std::pair("acceleration_x", -1.0), std::pair("acceleration_y", 1.0), std::pair("pitch_rate", -1.0)}) {
      const std::string path = "/vehicles/" + std::to_string(vehicle) + "/seat/" + name;
      const std::vector<double> a = one(path), b = other(path);
      ASSERT_EQ(a.size(), b.size()) << path;
      const double largest = std::abs(peak(a).first);
      EXPECT_GT(largest, 1e-4) << path;
      for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], sign * b[i], 1e-9 * largest) << path << " " << i;
    }
}

/// The same wheels at the same times with the same forces, at places that are mirrored.
void expect_mirrored_passages(Results& one, Results& other, double length) {
  const std::vector<double> x = one("/passages/x"), x_turned = other("/passages/x");
  ASSERT_GT(x.size(), 5U);
  ASSERT_EQ(x.size(), x_turned.size());
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], length - x_turned[i], 1e-12);
  for (const auto& [name, sign] : {std::pair("time", 1.0), std::pair("speed", -1.0), std::pair("normal_force", 1.0)}) {
    const std::string path = std::string("/passages/") + name;
    const std::vector<double> a = one(path), b = other(path);
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i], sign * b[i], 1e-9 * std::abs(a[i])) << path << " " << i;
  }
}

// The program mirrors a train that runs to the left: to the mirror image of the whole scene that is one.
TEST(Trains, MirroredSceneIsTheSame) {
  const TemporaryFolder folder;
  const std::string stop = folder.write("stop.csv", "0,25\n0.4,25\n2,5\n2.2,5\n2.6,0\n");
  const std::string start = folder.write("start.csv", "0,0\n1,-12\n2,-20\n");
  const std::string stop_turned = folder.write("stop_turned.csv", "0,-25\n0.4,-25\n2,-5\n2.2,-5\n2.6,0\n");
  const std::string start_turned = folder.write("start_turned.csv", "0,0\n1,12\n2,20\n");
  const std::string scene = bridge + car(folder, false) + R"(
trains: [up, down]
up: {vehicles: car*2, spacing: 9.0, couplers: [bar], bar: {bodies: [frame, frame], from: [-2.5, 1.2], to: [2.5, 1.4], stiffness: 2.0e6, damping: 1.0e4}}
down: {vehicles: car, positions: 58.0}
ts_max_time: 3.0
)";
  Results one = run_yaml(scene, {{"up_speed_file", stop}, {"down_speed_file", start}, {"output_passages", "9,30"}});
  Results other = run_yaml(scene, turned_bridge + Values{{"up_speed_file", stop_turned},
                                                         {"down_speed_file", start_turned},
                                                         {"down_positions", "7"},
                                                         {"output_passages", "56,35"}});
  // Places of some 60 m are known to 7e-15 m, and a contact of 1e9 N/m^1.5 makes 1e-7 N of that: 1e-12 of a force.
  const Difference two = difference_of_mirrored(one, other, {0, 1, 2});
  testing::Test::RecordProperty("mirrored_deflection", text(two.deflection));
  testing::Test::RecordProperty("mirrored_force", text(two.force));
  EXPECT_LT(two.deflection, 1e-12);
  EXPECT_LT(two.force, 1e-11);
  EXPECT_GT(std::abs(peak(one("/probes/deflection")).first), 1e-3);
  expect_mirrored_sensors(one, other, {0, 1, 2});
  expect_mirrored_passages(one, other, 65.0);

  // A vehicle written as its own mirror image, run to the right, is the vehicle run to the left.
  const Values right = {{"train_vehicles", "car"}, {"train_speed", "25"}, {"ts_max_time", "2.5"}};
  const Values left = {{"train_vehicles", "car"}, {"train_speed", "-25"}, {"ts_max_time", "2.5"}};
  Results written = run_yaml(bridge + car(folder, true), turned_bridge + left);
  Results plain = run_yaml(bridge + car(folder, false), right);
  Results back = run_yaml(bridge + car(folder, false), turned_bridge + left);
  // On the deflected beam the velocities of the start come from a system of equations, in which rounding leaves 1e-11.
  EXPECT_LT(difference_of_mirrored(plain, back, {0}).deflection, 1e-11);
  EXPECT_LT(difference_of_mirrored(plain, back, {0}).force, 1e-10);
  EXPECT_GT(difference_of_mirrored(plain, written, {0}).deflection, 1e-4) << "the vehicle is not its own mirror image";
}

// Steps end at no kinks of wheels here, so that all runs have the same ones; what is left is Newton's tolerance.
const Values steps_alike = {{"step_kinks", "false"}, {"model_vehicles", "full"}};
const std::string separate = R"(
beam: {spans: [20.0, 20.0], EI: 8.33e9, mass: 2303.0, damping_ratios: 0.02, elements_per_span: 8, continuity: simply_supported}
support: {types: [pinned, roller, roller]}
ts_dt: 1.0e-3
ts_max_time: 1.2
output: {interval: 0.01, probes: [9.3, 28.3]}
)";

// On spans that do not touch, trains know nothing of each other; forces add up everywhere.
TEST(Trains, FarApartAreTheSumOfEach) {
  const TemporaryFolder folder;
  const std::string scene = separate + car(folder, false);
  Results up = run_yaml(
      scene, steps_alike + Values{{"train_vehicles", "car"}, {"train_speed", "16"}, {"train_positions", "-3"}});
  Results down = run_yaml(
      scene, steps_alike + Values{{"train_vehicles", "car"}, {"train_speed", "-15"}, {"train_positions", "43"}});
  Results both = run_yaml(scene, steps_alike + Values{{"trains", "up,down"},
                                                      {"up_vehicles", "car"},
                                                      {"up_speed", "16"},
                                                      {"up_positions", "-3"},
                                                      {"down_vehicles", "car"},
                                                      {"down_speed", "-15"},
                                                      {"down_positions", "43"}});
  EXPECT_LT(relative_difference(both.column("/probes/deflection", 0), up.column("/probes/deflection", 0)), 1e-9);
  EXPECT_LT(relative_difference(both.column("/probes/deflection", 1), down.column("/probes/deflection", 1)), 1e-9);
  EXPECT_LT(
      relative_difference(both("/vehicles/1/front_wheel/normal_force"), down("/vehicles/0/front_wheel/normal_force")),
      1e-9);

  const Values a = {{"load_forces", "1e5,2e5"}, {"load_positions", "0,-4.5"}, {"load_speed", "30"}};
  const Values b = {{"load_forces", "1.5e5"}, {"load_positions", "63"}, {"load_speed", "-35"}};
  const Values sum = {{"loads", "a,b"},      {"a_forces", "1e5,2e5"}, {"a_positions", "0,-4.5"}, {"a_speed", "30"},
                      {"b_forces", "1.5e5"}, {"b_positions", "63"},   {"b_speed", "-35"}};
  const Values end = steps_alike + Values{{"ts_max_time", "2.0"}};
  Results first = run_yaml(bridge, a + end), second = run_yaml(bridge, b + end), all = run_yaml(bridge, sum + end);
  for (const char* name : {"/probes/deflection", "/supports/reaction"}) {
    std::vector<double> added = first(name);
    for (std::size_t i = 0; i < added.size(); ++i) added[i] += second(name)[i];
    EXPECT_LT(relative_difference(all(name), added), 1e-10) << name;
  }
}

// A train that has come to rest on the bridge ends in the static state there.
TEST(Trains, StopsInItsStaticState) {
  const TemporaryFolder folder;
  const std::string stop = folder.write("stop.csv", "0,20\n25,0\n");
  const Values predicted = {{"beam_damping_ratios", "0.2"},
                            {"vehicle_car_push_table", folder.write("none.csv", "0,0,0\n1,0,0\n")}};
  std::string round = car(folder, false);
  for (const char* shape : {", flat_length: 0.03", ", flat_angle: 0.400000", ", polygon_order: 3",
                            ", polygon_amplitude: 1.0e-4", ", polygon_phase: 0.800000"})
    round.erase(round.find(shape), std::string(shape).size());
  Results run = run_yaml(bridge + round, predicted + Values{{"train_vehicles", "car"},
                                                            {"train_speed_file", stop},
                                                            {"train_speed_over", "position"},
                                                            {"scene_tail", "30"},
                                                            {"output_interval", "0.5"}});
  EXPECT_NEAR(run.time().back(), 2.5 + 30.0, 0.5) << "the run ends so long after the standstill";
  Results rest =
      run_yaml(bridge + round,
               predicted + Values{{"train_vehicles", "car"}, {"train_positions", "23"}, {"scene_analysis", "static"}});
  EXPECT_NEAR(run.column("/vehicles/0/front_axle/position", 0).back(), 25.0, 1e-12);
  for (const std::size_t p : {0, 1, 2})
    EXPECT_NEAR(run.column("/probes/deflection", p).back(), rest.column("/probes/deflection", p).back(), 1e-9);
  EXPECT_NEAR(run("/vehicles/0/front_wheel/normal_force").back(), rest("/vehicles/0/front_wheel/normal_force").back(),
              1e-1);
}

// What a coupling bar pulls and pushes changes the momentum of the wagon behind it, which nothing else does on level
// ground; and the drive's work is the change of all energy.
TEST(Trains, ImpulseAndWorkOfABrakedTrain) {
  const TemporaryFolder folder;
  const std::string stop = folder.write("stop.csv", "0,30\n1,30\n3,12\n4,12\n5,0\n");
  const std::string scene = R"(
vehicle:
  wagon:
    bodies: [body]
    wheels: [front, rear]
    body: {mass: 2.0e4, inertia: 1.0e4, position: [0.0, 0.5]}
    front: {body: body, radius: 0.5, law: linear, stiffness: 1.0e8}
    rear: {body: body, radius: 0.5, law: linear, stiffness: 1.0e8}
train:
  vehicles: wagon*2
  positions: [0.0, -8.0]
  couplers: [bar]
  bar: {type: distance, bodies: [body, body], from: [-1.0, 0.5], to: [1.0, 0.5]}
ts_dt: 1.0e-3
ts_max_time: 6.0
output: {interval: 0.01}
)";
  for (const char* vehicles : {"full", "linear"}) {
    Results run = run_yaml(scene, {{"train_speed_file", stop}, {"model_vehicles", vehicles}});
    const std::vector<double> time = run.time(), force = run("/couplers/bar/fx");
    const std::vector<double> speed = run.column("/vehicles/1/body/velocity", 0);
    // Piece by piece of the speed's table, within which the force is constant: its value in the middle of each.
    const std::array<double, 6> ends = {0.0, 1.0, 3.0, 4.0, 5.0, 6.0};
    double impulse = 0.0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      impulse += (ends[i + 1] - ends[i]) * force[static_cast<std::size_t>(std::lround(50.0 * (ends[i] + ends[i + 1])))];
    const double momentum = 2.0e4 * (speed.back() - speed.front());
    testing::Test::RecordProperty("impulse_error", text(std::abs(impulse / momentum - 1.0)));
    EXPECT_NEAR(impulse / momentum, 1.0, 1e-9);
    EXPECT_NEAR(speed.front(), 30.0, 1e-12);
    EXPECT_NEAR(speed.back(), 0.0, 1e-10);
    EXPECT_NEAR(run("/energy/work").back(), -0.5 * 4.0e4 * 900.0, 1e-9 * 1.8e7);
  }
}

}  // namespace
}  // namespace traverse::test
