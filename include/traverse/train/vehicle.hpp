// Vehicles, trains and moving forces as they meet the track.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "traverse/contact/body_contact.hpp"
#include "traverse/multibody/model.hpp"
#include "traverse/track/wheel_shape.hpp"

namespace traverse::train {

/// A circle around the centre of mass of a body, in contact with the running surface.
struct Wheel {
  std::string name;
  int body = 0;
  double radius = 0.0;  // m
  contact::Law law;
  track::WheelShape shape;  // what is out of round
};

/// A point fixed to a body, whose motion is stored.
struct Sensor {
  std::string name;
  int body = 0;
  Eigen::Vector2d arm = Eigen::Vector2d::Zero();  // from the centre of mass, in the body's axes, m
};

/// One vehicle type; positions relative to the vehicle's origin.
struct Vehicle {
  std::string name;
  multibody::MechanismModel mechanism;
  std::vector<Wheel> wheels;
  std::vector<contact::BodyContact> contacts;
  std::vector<Sensor> sensors;
};

/// constant: x of each vehicle's first body is prescribed; free: only forces act.
enum class Drive { constant, free };

/// What joins neighbours in a train: a joint, or else a spring. `point` and `from` count from the origin of the vehicle
/// in front, `to` from that of the one behind.
struct Coupler {
  std::string name;
  std::array<std::string, 2> bodies;  // of the vehicle in front, of the one behind
  std::vector<int> gaps;              // behind which vehicles of the train, from 0
  std::optional<multibody::Joint> joint;
  multibody::Spring spring;
};

struct Train {
  std::vector<int> vehicles;      // indices into a list of types, front one first
  std::vector<double> positions;  // x of each origin at t = 0, m
  double speed = 0.0;             // m/s
  Drive drive = Drive::constant;
  std::vector<Coupler> couplers;
};

/// Moving constant forces.
struct MovingLoad {
  std::vector<double> forces;     // N, downward
  std::vector<double> positions;  // x at t = 0, m
  double speed = 0.0;             // m/s
};

}  // namespace traverse::train
