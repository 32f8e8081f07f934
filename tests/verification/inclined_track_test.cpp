// Beams and trains on an incline against closed forms: x is along the beam, gravity has a component along it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "support/message.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

constexpr double gravity = 9.81, gradient = 0.3, mass = 6000.0;  // m/s2, 1, kg
const double along = gravity * gradient / std::hypot(1.0, gradient), across = gravity / std::hypot(1.0, gradient);

/// A car of two axles, each with a wheel, whose body is carried by springs.
const char* const coach =
    "vehicle:\n  car:\n    bodies: [body, front_axle, rear_axle]\n    joints: [front_guide, rear_guide]\n"
    "    springs: [front_spring, rear_spring]\n    drivers: [front_level, rear_level]\n    wheels: [front, rear]\n"
    "    body: {mass: 5000, inertia: 9000, position: [-1.5, 1.2]}\n"
    "    front_axle: {mass: 500, inertia: 20, position: [0.0, 0.5]}\n"
    "    rear_axle: {mass: 500, inertia: 20, position: [-3.0, 0.5]}\n"
    "    front_guide: {type: slot, bodies: [body, front_axle], point: [0.0, 0.5], axis: [0.0, 1.0]}\n"
    "    rear_guide: {type: slot, bodies: [body, rear_axle], point: [-3.0, 0.5], axis: [0.0, 1.0]}\n"
    "    front_spring: {bodies: [front_axle, body], from: [0.0, 0.5], to: [0.0, 1.2], stiffness: 4.0e5, damping: "
    "1.0e4}\n"
    "    rear_spring: {bodies: [rear_axle, body], from: [-3.0, 0.5], to: [-3.0, 1.2], stiffness: 4.0e5, damping: "
    "1.0e4}\n"
    "    front_level: {body: front_axle, coordinate: phi, value: 0.0}\n"
    "    rear_level: {body: rear_axle, coordinate: phi, value: 0.0}\n"
    "    front: {body: front_axle, radius: 0.5, law: linear, stiffness: 2.0e7}\n"
    "    rear: {body: rear_axle, radius: 0.5, law: linear, stiffness: 2.0e7}\n";
const char* const bridge =
    "beam: {spans: 20, EI: 8.0e9, EA: 2.0e10, mass: 9000, elements_per_span: 6}\nsupport: {types: [pinned, roller]}\n";

const char* const stiff_bridge =
    "beam: {spans: 20, EI: 8.0e13, EA: 2.0e10, mass: 9000, elements_per_span: 6}\nsupport: {types: [pinned, roller]}\n";

// Nothing but gravity acts along the track, so that the centre of mass has a constant acceleration.
TEST(InclinedTrack, ATrainRollsDown) {
  Results run = run_yaml(std::string(coach) +
                         "train: {vehicles: car, positions: 0.0, speed: 12.0, drive: free}\ntrack: {gradient: 0.3}\n"
                         "ts: {dt: 5.0e-3, max_time: 6.0}\noutput: {interval: 0.1}\n");
  const std::vector<double> time = run.time(), body = run("/vehicles/0/body/position"),
                            front = run("/vehicles/0/front_axle/position"),
                            rear = run("/vehicles/0/rear_axle/position"),
                            left = run.column("/vehicles/0/front/normal_force"),
                            right = run.column("/vehicles/0/rear/normal_force");
  const auto centre = [&](std::size_t i) {
    return (5000.0 * body[3 * i] + 500.0 * front[3 * i] + 500.0 * rear[3 * i]) / mass;
  };
  for (std::size_t i = 0; i < time.size(); ++i)
    EXPECT_NEAR(centre(i) - centre(0), 12.0 * time[i] - 0.5 * along * time[i] * time[i], 1e-8) << time[i];
  EXPECT_NEAR(left.front() + right.front(), mass * across, 1e-6 * mass * across);
  EXPECT_LT(energy_error(run), 1e-8);
}

// N = -m g sin(a) (L - x), u = -m g sin(a) (L x - x^2/2)/EA; the pinned support at the lower end carries everything.
TEST(InclinedTrack, WeightOfABeam) {
  Results run = run_yaml(std::string(bridge) +
                         "beam_self_weight: true\ntrack: {gradient: 0.3}\nscene: {analysis: static}\n"
                         "output: {probes: [2.2, 9.0, 17.5]}\nload: {forces: 0, speed: 0}\n");
  const double probes[] = {2.2, 9.0, 17.5}, length = 20.0, per_length = 9000.0 * along, EA = 2.0e10;
  const std::vector<double> force = run("/probes/axial_force"), displacement = run("/probes/axial_displacement"),
                            moment = run("/probes/moment"), reaction = run("/supports/reaction");
  for (std::size_t p = 0; p < 3; ++p) {
    const double x = probes[p];
    EXPECT_NEAR(force[p], -per_length * (length - x), 1e-9 * per_length * length) << x;
    EXPECT_NEAR(displacement[p], -per_length * (length * x - 0.5 * x * x) / EA,
                1e-9 * per_length * length * length / EA);
    EXPECT_NEAR(moment[p], 0.5 * 9000.0 * across * x * (length - x), 1e-9 * 9000.0 * across * length * length);
  }
  EXPECT_NEAR(reaction[0], per_length * length, 1e-9 * per_length * length);
}

// The drive holds the vehicles on the incline; the track carries this force at the wheels. The beam is stiff: where it
// is inclined by its deflection, the wheels' normal forces have a component along x, too.
TEST(InclinedTrack, ATrainThatIsHeld) {
  Results run = run_yaml(std::string(stiff_bridge) + coach +
                         "train: {vehicles: car, positions: 13.0, speed: 10.0}\ntrack: {gradient: 0.3}\n"
                         "scene: {analysis: static}\noutput: {probes: [5.0, 16.0]}\n");
  const std::vector<double> force = run("/probes/axial_force"), reaction = run("/supports/reaction");
  EXPECT_NEAR(reaction[0], mass * along, 1e-6 * mass * along);
  EXPECT_NEAR(force[0], -mass * along, 1e-6 * mass * along);
  EXPECT_NEAR(force[1], 0.0, 1e-6 * mass * along);
  const double vertical = run("/balance/support")[1];
  EXPECT_NEAR(vertical, mass * across, 1e-6 * mass * across);
}

TEST(InclinedTrack, ATrainThatIsDrivenUp) {
  for (const char* vehicles : {"full", "linear"}) {
    Results run = run_yaml(std::string(bridge) + coach + "beam_self_weight: true\nmodel: {vehicles: " + vehicles +
                           "}\ntrain: {vehicles: car, positions: 0.0, speed: 20.0}\ntrack: {gradient: 0.3}\n"
                           "ts: {dt: 1.0e-3, max_time: 1.2}\noutput: {interval: 0.01}\n");
    EXPECT_LT(energy_error(run), 1e-6) << vehicles;
    const std::vector<double> time = run.time(), residual = run("/balance/residual"), support = run("/balance/support");
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < time.size(); ++i) {
      EXPECT_LT(std::abs(residual[2 * i]), 1e-6 * 9000.0 * 20.0 * along) << time[i];
      if (time[i] < 0.2 || time[i] > 0.95) continue;
      sum += support[2 * i];
      ++count;
    }
    const double weight = 9000.0 * 20.0 * along;
    EXPECT_NEAR(sum / count - weight, mass * along, 0.03 * mass * along) << vehicles;
  }
}

TEST(InclinedTrack, RefusesWhatItCannotModel) {
  EXPECT_TRUE(contains(
      message_of([&] { run_yaml(std::string(bridge) + "track: {gradient: 3.0}\nload: {forces: 1, speed: 1}\n"); }),
      "track_gradient"));
}

}  // namespace
}  // namespace traverse::test
