// Why the kernels do not compute the vehicles of a fleet.
#include <fmt/format.h>

#include "engine/train_arrays.hpp"
#include "train/linear_dynamics.hpp"

#pragma GCC diagnostic error "-Wswitch"  // each switch over contact::LawKind has a case for every kind

namespace traverse::engine {
namespace {

constexpr int most_freedom = 64;  // limit for a vehicle; matrices of larger vehicles are mostly zero

/// Why the kernels, which know k a^1.5 and k a, do not compute a contact law; null if they do.
const char* obstacle_of(contact::LawKind kind) {
  switch (kind) {
    case contact::LawKind::hertz:
    case contact::LawKind::linear:
      break;
    case contact::LawKind::two_sided:
      return "has a two-sided contact";
    case contact::LawKind::other:
      return "has a contact law of its own";
  }
  return nullptr;
}

}  // namespace

std::string TrainArrays::obstacle(const train::Fleet& fleet) {
  if (fleet.vehicles.empty()) return "no vehicles run";
  if (!fleet.pairs.empty()) return "bodies of its vehicles touch each other";
  for (const train::MovingVehicle& vehicle : fleet.vehicles) {
    const auto vehicle_obstacle = [&](const std::string& why) {
      return fmt::format("vehicle '{}': {}", vehicle.name(), why);
    };
    if (vehicle.dynamics->linear() == nullptr) return vehicle_obstacle("it is not linearised");
    if (!vehicle.mechanism.model().actuators.empty()) return vehicle_obstacle("actuators act on it");
    if (vehicle.freedom() > most_freedom || vehicle.wheels.size() > most_wheels)
      return vehicle_obstacle("it has too many parts");
    for (const train::Wheel& wheel : vehicle.wheels) {
      const auto wheel_obstacle = [&](const char* why) {
        return vehicle_obstacle(fmt::format("its wheel '{}' {}", wheel.name, why));
      };
      if (wheel.law.damping != 0.0 || wheel.law.hysteresis) return wheel_obstacle("has a contact with damping");
      if (const char* why = obstacle_of(wheel.law.kind); why != nullptr) return wheel_obstacle(why);
      if (wheel.law.friction != 0.0) return wheel_obstacle("has a contact with friction");
      if (!wheel.shape.round()) return wheel_obstacle("is out of round");
    }
  }
  for (const train::WheelContact& wheel : fleet.wheels)
    if (wheel.may_touch_several_points) return "a wheel may touch the track at several points";
  return {};
}

}  // namespace traverse::engine
