// The energy balance of whole runs, and Newton's law for each body from what the results file says of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

// A car on two wheelsets that roll: they turn at about the train's speed over the radius, and slip a little at first.
constexpr const char* rolling = R"(
beam: {spans: [20.0, 25.0, 20.0], elements_per_span: 6, EI: 8.33e9, EA: 1.2e10, mass: 2303.0, damping_ratios: [0.02, 0.02]}
support: {types: [pinned, roller, roller, roller]}
vehicle:
  car:
    bodies:  [body, front_axle, rear_axle]
    joints:  [front_guide, rear_guide]
    springs: [front_suspension, rear_suspension]
    wheels:  [front_wheel, rear_wheel]
    body:       {mass: 17735.0, inertia: 1.47e5, position: [0.0, 1.5]}
    front_axle: {mass: 1500.0, inertia: 100.0, position: [2.0, 0.5], velocity: [0.0, 0.0, -61.0]}
    rear_axle:  {mass: 1000.0, inertia: 100.0, position: [-2.0, 0.5], velocity: [0.0, 0.0, -60.0]}
    front_guide: {type: slot, bodies: [body, front_axle], point: [2.0, 0.5], axis: [0.0, 1.0]}
    rear_guide:  {type: slot, bodies: [body, rear_axle], point: [-2.0, 0.5], axis: [0.0, 1.0]}
    front_suspension: {bodies: [body, front_axle], from: [2.0, 1.5], to: [2.0, 0.5], stiffness: 2.47e6, damping: 3.0e4}
    rear_suspension:  {bodies: [body, rear_axle], from: [-2.0, 1.5], to: [-2.0, 0.5], stiffness: 4.23e6, damping: 4.0e4}
    front_wheel: {body: front_axle, radius: 0.5, law: hertz, stiffness: 1.0e9, damping: 1.0e4, friction: 0.3, transition_speed: 0.2}
    rear_wheel:  {body: rear_axle, radius: 0.5, law: linear, stiffness: 3.0e7, damping: 1.0e4, friction: 0.3, transition_speed: 0.2}
train: {vehicles: car, positions: 5.0, speed: 30.0}
ts: {max_time: 1.8, dt: 5.0e-4}
output: {interval: 0.01}
)";  // on the bridge from start to end: see Passage below for its ends

struct Balance {
  double residual, scale;  // J; of the terms except for the kinetic energy of going forward
};

double range(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end()) - *std::min_element(values.begin(), values.end());
}

Balance balance(Results& run) {
  std::vector<double> motion = run("/energy/kinetic");
  for (std::size_t i = 0; i < motion.size(); ++i) motion[i] += run("/energy/potential")[i];
  const double scale = std::max(
      {range(run("/energy/work")), range(run("/energy/dissipated")), range(run("/energy/strain")), range(motion)});
  return {std::abs(peak(run("/energy/residual")).first), scale};
}

void expect_balance(Results run) {
  const Balance b = balance(run);
  testing::Test::RecordProperty("residual_over_scale", text(b.residual / b.scale));
  EXPECT_GT(b.scale, 1.0);
  EXPECT_LT(b.residual, 1e-6 * b.scale);
  // The residual is what the file's other terms leave.
  const auto stored = [&](std::size_t i) {
    return run("/energy/kinetic")[i] + run("/energy/strain")[i] + run("/energy/potential")[i];
  };
  const std::size_t last = run.time().size() - 1;
  EXPECT_NEAR(stored(last) - stored(0) + run("/energy/dissipated")[last] - run("/energy/work")[last],
              run("/energy/residual")[last], 1e-9 * std::abs(stored(0)) + 1e-9 * b.scale);
}

TEST(Energy, HertzWheelWithoutDamping) {
  Results run =
      run_scene("r4_hertz_wheel", {{"beam_elements_per_span", "8"}, {"ts_dt", "5e-4"}, {"output_interval", "5e-3"}});
  EXPECT_EQ(peak(run("/energy/dissipated")).first, 0.0);
  expect_balance(run);
}

TEST(Energy, MovingForceAndTheVibrationItLeaves) {
  expect_balance(run_scene(
      "r1_moving_force",
      {{"beam_elements_per_span", "8"}, {"ts_dt", "2.5e-4"}, {"output_interval", "1e-3"}, {"scene_tail", "0.2"}}));
}

TEST(Energy, ForcesOnABridgeWithWeightAndFoundation) {
  expect_balance(run_yaml(R"(
beam: {spans: [20.0, 25.0], elements_per_span: 6, EI: 8.33e9, mass: 2303.0, damping_ratios: [0.01, 0.018], self_weight: true}
support: {types: [pinned, free, guided]}
foundation:
  vertical: {x: [7.0, 20.0], k: [1.0e7, 8.0e7], c: [2.0e5, 1.0e4]}
  vertical_bed: {k: 2.0e5, c: 1.0e3}
  rotational: {x: [20.0, 33.0], k: [1.0e8, 0.0], c: [1.0e5, 2.0e5]}
load: {forces: [1.0e5, 5.0e4], positions: [10.0, 4.0], speed: 40.0}
ts: {dt: 2.5e-4}
output: {interval: 0.01}
)"));
}

TEST(Energy, RollingTrainDrivenAtConstantSpeed) { expect_balance(run_yaml(rolling)); }

TEST(Energy, RollingTrainLeftToItself) {
  Results run = run_yaml(rolling, {{"train_drive", "free"}});
  EXPECT_EQ(peak(run("/energy/work")).first, 0.0);
  EXPECT_GT(run("/energy/dissipated").back(), 10.0);
  expect_balance(run);
}

TEST(Energy, BrakedTrain) {
  const TemporaryFolder folder;  // both begin at 0, for a wheel that can turn has no equilibrium under a moment
  const std::string brake = folder.write("brake.csv", "0, 0\n0.5, 8e3\n1.0, 8e3\n10.0, 2e3\n");
  const std::string wind = folder.write("wind.csv", "0, 0, 0\n0.5, -3e3, 1e3\n10.0, -3e3, -2e3\n");
  const Values actuators = {{"train_drive", "free"},
                            {"vehicle_car_actuators", "brake,wind"},
                            {"vehicle_car_brake_bodies", "front_axle,body"},
                            {"vehicle_car_brake_table", brake},
                            {"vehicle_car_wind_body", "body"},
                            {"vehicle_car_wind_table", wind}};
  Results run = run_yaml(rolling, actuators);
  EXPECT_LT(run("/energy/work").back(), -1e3);
  expect_balance(run);
}

TEST(Energy, SlidingHalfCarsOnThreeSpans) {
  expect_balance(run_scene("three_span_half_car", {{"train_positions", "15,5"},
                                                   {"ts_max_time", "2.0"},
                                                   {"ts_dt", "5e-4"},
                                                   {"output_interval", "0.01"},
                                                   {"vehicle_half_car_front_wheel_damping", "1e4"},
                                                   {"vehicle_half_car_rear_wheel_damping", "2e4"}}));
}

// The same without friction, where nothing large hides a small residual.
TEST(Energy, HalfCarsOnThreeSpans) {
  expect_balance(run_scene("three_span_half_car", {{"train_positions", "15,5"},
                                                   {"ts_max_time", "2.0"},
                                                   {"ts_dt", "5e-4"},
                                                   {"output_interval", "0.01"},
                                                   {"vehicle_half_car_front_wheel_friction", "0"},
                                                   {"vehicle_half_car_front_wheel_damping", "1e4"},
                                                   {"vehicle_half_car_rear_wheel_damping", "2e4"}}));
}

TEST(Energy, BumpOnTheBridge) {
  expect_balance(run_yaml(rolling, {{"track_profile", "bump"},
                                    {"track_bump_start", "22"},
                                    {"track_bump_length", "3"},
                                    {"track_bump_height", "0.004"},
                                    {"vehicle_car_front_wheel_friction", "0"},
                                    {"vehicle_car_rear_wheel_friction", "0"},
                                    {"ts_dt", "2.5e-4"}}));
}

// At the ends of a bent bridge the surface has a kink of angle theta, which a wheel passes within r theta/v, far less
// than a step. Its force N turns by theta there, at an instant inside a step, so that the work of the drive is known
// to N theta v h only: the bound asserted, for all wheels at both ends.
TEST(Energy, PassageOverBothEnds) {
  const double speed = 30.0, step = 2.5e-4, slope = 2e-3, force = 1.1e5;
  Results run = run_yaml(
      rolling,
      {{"train_positions", "-5"}, {"ts_max_time", "2.5"}, {"ts_dt", text(step)}, {"output_probes", "0.01,64.99"}});
  EXPECT_LT(std::abs(peak(run("/probes/deflection")).first) / 0.01, slope);
  EXPECT_LT(std::abs(peak(run("/vehicles/0/front_wheel/normal_force")).first), force);
  EXPECT_LT(std::abs(peak(run("/energy/residual")).first), 4.0 * force * slope * speed * step);
}

// --- Newton's law

struct Force {
  double x = 0.0, y = 0.0, moment = 0.0;  // about the body's centre of mass
};

// A body of vehicle 0 at one instant.
struct Motion {
  double position[3], velocity[3], acceleration[3];
};
Motion motion(Results& run, const std::string& body, std::size_t row) {
  Motion m;
  for (std::size_t i = 0; i < 3; ++i) {
    m.position[i] = run("/vehicles/0/" + body + "/position")[3 * row + i];
    m.velocity[i] = run("/vehicles/0/" + body + "/velocity")[3 * row + i];
    m.acceleration[i] = run("/vehicles/0/" + body + "/acceleration")[3 * row + i];
  }
  return m;
}

struct Spring {
  double from[2], to[2];  // from the centres of mass, at angle 0
  double stiffness, damping, free_length;
};

// What a spring does to its second body; the first one takes the opposite at its own end.
void spring_forces(const Spring& s, const Motion& first, const Motion& second, Force& on_first, Force& on_second) {
  double arm[2][2], point[2][2], rate[2][2];
  for (int end = 0; end < 2; ++end) {
    const Motion& m = end == 0 ? first : second;
    const double* r = end == 0 ? s.from : s.to;
    const double c = std::cos(m.position[2]), d = std::sin(m.position[2]);
    arm[end][0] = c * r[0] - d * r[1];
    arm[end][1] = d * r[0] + c * r[1];
    for (int i = 0; i < 2; ++i) point[end][i] = m.position[i] + arm[end][i];
    rate[end][0] = m.velocity[0] - m.velocity[2] * arm[end][1];
    rate[end][1] = m.velocity[1] + m.velocity[2] * arm[end][0];
  }
  const double dx = point[1][0] - point[0][0], dy = point[1][1] - point[0][1], length = std::hypot(dx, dy);
  const double stretching = ((rate[1][0] - rate[0][0]) * dx + (rate[1][1] - rate[0][1]) * dy) / length;
  const double tension = s.stiffness * (length - s.free_length) + s.damping * stretching;
  for (int end = 0; end < 2; ++end) {
    const double sign = end == 0 ? 1.0 : -1.0;
    const double fx = sign * tension * dx / length, fy = sign * tension * dy / length;
    Force& f = end == 0 ? on_first : on_second;
    f.x += fx;
    f.y += fy;
    f.moment += arm[end][0] * fy - arm[end][1] * fx;
  }
}

// Body and wheel of R4: the spring alone holds the body, the wheel's force and the spring the axle.
TEST(Newton, SprungBodyOnAHertzWheel) {
  Results run = run_scene("r4_hertz_wheel", {{"beam_elements_per_span", "8"}, {"ts_dt", "1e-3"}});
  const double weight = 6750.0 * 9.81;
  double worst_body = 0.0, worst_axle = 0.0, worst_guide = 0.0;
  for (std::size_t i = 0; i < run.time().size(); ++i) {
    const Motion body = motion(run, "body", i), axle = motion(run, "axle", i);
    const double push = 1.595e6 * (1.54 - (body.position[1] - axle.position[1]));
    const double guide_x = run("/vehicles/0/guide/reaction")[3 * i];
    const double normal = run("/vehicles/0/wheel/normal_force")[i];
    // The wheel's force stands normal to the bent beam; what it pushes along x, the guide takes.
    const double wheel_y = std::sqrt(normal * normal - guide_x * guide_x);
    worst_body = std::max(worst_body, std::abs(5750.0 * (body.acceleration[1] + 9.81) - push));
    worst_axle = std::max(worst_axle, std::abs(1000.0 * (axle.acceleration[1] + 9.81) + push - wheel_y));
    worst_guide = std::max(worst_guide, std::abs(run("/vehicles/0/guide/reaction")[3 * i + 1]));
  }
  EXPECT_LT(worst_body, 1e-9 * weight);
  EXPECT_LT(worst_axle, 1e-9 * weight);
  EXPECT_LT(worst_guide, 1e-9 * weight);
}

// Every body of a half car with friction: joints, springs, wheels and weight give m a and I phi''.
TEST(Newton, HalfCarWithFriction) {
  Results run = run_scene("three_span_half_car", {{"train_vehicles", "half_car"},
                                                  {"train_positions", "-5"},
                                                  {"ts_dt", "2e-3"},
                                                  {"output_interval", "0.02"},
                                                  {"scene_tail", "0.1"},
                                                  {"vehicle_half_car_front_wheel_damping", "1e4"}});
  const double g = 9.81, weight = (17735.0 + 2500.0) * g;
  const Spring springs[2] = {{{2.0, 0.0}, {0.0, 0.0}, 2.47e6, 3.0e4, 1.0},
                             {{-2.0, 0.0}, {0.0, 0.0}, 4.23e6, 4.0e4, 1.0}};
  const std::string ends[2] = {"front", "rear"};
  const double masses[2] = {1500.0, 1000.0};
  double worst = 0.0, worst_moment = 0.0, rubbed = 0.0;
  for (std::size_t i = 0; i < run.time().size(); ++i) {
    const Motion car = motion(run, "car", i);
    Force on_car{0.0, -17735.0 * g, 0.0};
    for (int end = 0; end < 2; ++end) {
      const Motion axle = motion(run, ends[end] + "_axle", i);
      Force on_axle{0.0, -masses[end] * g, 0.0};
      spring_forces(springs[end], car, axle, on_car, on_axle);
      // The joint's point lies half a metre above the axle's centre, on the axle; its force acts there on both.
      const double* r = &run("/vehicles/0/" + ends[end] + "_guide/reaction")[3 * i];
      const double c = std::cos(axle.position[2]), s = std::sin(axle.position[2]);
      const double arm[2] = {-0.5 * s, 0.5 * c};
      const double car_arm[2] = {axle.position[0] + arm[0] - car.position[0],
                                 axle.position[1] + arm[1] - car.position[1]};
      on_axle.x += r[0];
      on_axle.y += r[1];
      on_axle.moment += r[2] + arm[0] * r[1] - arm[1] * r[0];
      on_car.x -= r[0];
      on_car.y -= r[1];
      on_car.moment -= r[2] + car_arm[0] * r[1] - car_arm[1] * r[0];
      // What is left is the wheel's: normal and friction at right angles, in a direction that the file does not tell.
      const std::string wheel = "/vehicles/0/" + ends[end] + "_wheel/";
      const double normal = run(wheel + "normal_force")[i], friction = run(wheel + "friction_force")[i];
      const double fx = masses[end] * axle.acceleration[0] - on_axle.x;
      const double fy = masses[end] * axle.acceleration[1] - on_axle.y;
      worst = std::max(worst, std::abs(std::hypot(fx, fy) - std::hypot(normal, friction)));
      const double radius = 0.5 - run(wheel + "penetration")[i];
      worst_moment =
          std::max(worst_moment, std::abs(100.0 * axle.acceleration[2] - on_axle.moment + friction * radius));
      EXPECT_LT(std::abs(fx + friction), 2e-3 * normal);  // a positive friction force drags the sliding wheel back
      rubbed = std::max(rubbed, std::abs(friction));
    }
    worst = std::max(worst, std::abs(17735.0 * car.acceleration[1] - on_car.y));
    worst_moment = std::max(worst_moment, std::abs(1.47e5 * car.acceleration[2] - on_car.moment));
  }
  EXPECT_GT(rubbed, 2e4);
  EXPECT_LT(worst, 1e-9 * weight);
  EXPECT_LT(worst_moment, 1e-9 * weight);
}

}  // namespace
}  // namespace traverse::test
