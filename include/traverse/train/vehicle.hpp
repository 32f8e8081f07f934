// Vehicles, trains and moving forces as they meet the track.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/base/speed_law.hpp"
#include "traverse/contact/body_contact.hpp"
#include "traverse/multibody/model.hpp"
#include "traverse/track/profile.hpp"
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

/// One of several trains or groups of forces, or one whose speed changes or is below 0.
struct Course {
  std::string name;       // of its block of options
  std::size_t first = 0;  // of its vehicles or forces, which go on to the next course's
  base::SpeedLaw speed;
  Drive drive = Drive::constant;
  std::shared_ptr<const track::Profile> profile;  // that its wheels run on; null: the track's
};

/// The trains on the track: one that runs to the right at a constant speed where there are no courses.
struct Train {
  std::vector<int> vehicles;      // indices into a list of types, train by train, the front one first
  std::vector<double> positions;  // x of each origin at t = 0, m
  double speed = 0.0;             // m/s; with courses the greatest magnitude of all
  Drive drive = Drive::constant;  // with courses: free where one is
  std::vector<Coupler> couplers;  // their gaps number all vehicles
  std::vector<Course> courses;    // ascending in `first`

  /// Whether all vehicles run to the right at one constant, prescribed speed.
  bool steady() const { return courses.empty() && drive == Drive::constant && speed > 0.0; }
};

/// Moving constant forces.
struct MovingLoad {
  std::vector<double> forces;     // N, downward
  std::vector<double> positions;  // x at t = 0, m
  double speed = 0.0;             // m/s; with courses the greatest magnitude of all
  std::vector<Course> courses;    // as a train's
};

/// The course of vehicle or force `i`; null where there are no courses.
template <class Moving>
const Course* course_of(const Moving& moving, std::size_t i) {
  const Course* found = nullptr;
  for (const Course& course : moving.courses)
    if (course.first <= i) found = &course;
  return found;
}

/// How vehicle or force `i` of a train or load runs.
template <class Moving>
base::SpeedLaw law_of(const Moving& moving, std::size_t i) {
  const Course* course = course_of(moving, i);
  return course == nullptr ? base::SpeedLaw(moving.speed) : course->speed;
}

/// Its speed at t, m/s.
template <class Moving>
double speed_of(const Moving& moving, std::size_t i, double t) {
  const Course* course = course_of(moving, i);
  return course == nullptr ? moving.speed : course->speed.speed(t);
}

/// x of force `i` at t, or of the origin of vehicle `i` where its x is prescribed.
template <class Moving>
double place_of(const Moving& moving, std::size_t i, double t) {
  const Course* course = course_of(moving, i);
  return moving.positions[i] + (course == nullptr ? moving.speed * t : course->speed.distance(t));
}

/// How the speed of a vehicle is prescribed: by its course, or by the train.
inline Drive drive_of(const Train& train, std::size_t vehicle) {
  const Course* course = course_of(train, vehicle);
  return course == nullptr ? train.drive : course->drive;
}

}  // namespace traverse::train
