// Vehicles, trains and moving forces on the track. The part of a moving force that changes over time is a Fourier
// series of one frequency, a table, or both.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/base/speed_law.hpp"
#include "traverse/base/time_function.hpp"
#include "traverse/contact/body_contact.hpp"
#include "traverse/multibody/model.hpp"
#include "traverse/track/profile.hpp"
#include "traverse/track/wheel_shape.hpp"

namespace traverse::train {

/// sum_k amplitude_k sin(2 pi k f t + phase_k) + table(t), added to the constant part of each force (N) or line load
/// (N/m) of a group; positive downward.
struct ForceVariation {
  double frequency = 0.0;                   // f, Hz
  std::vector<double> amplitudes;           // amplitudes of the harmonics k = 1, 2, ..., N or N/m
  std::vector<double> phases;               // rad, one for each amplitude
  std::optional<base::TimeFunction> table;  // piecewise linear

  /// Whether the force varies.
  bool varies() const { return table || !amplitudes.empty(); }
  /// The value at t (s), N or N/m.
  double at(double t) const;
  /// The frequency of the highest harmonic with an amplitude, Hz; 0 without harmonics.
  double highest_frequency() const;
  /// Times at which the rate of the force jumps.
  std::vector<double> kinks() const { return table ? table->kinks() : std::vector<double>(); }
};

/// A circle around the centre of mass of a body, in contact with the running surface.
struct Wheel {
  std::string name;
  int body = 0;
  double radius = 0.0;  // m
  contact::Law law;
  track::WheelShape shape;  // deviations from a circle
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

/// The connection of neighbours in a train: a joint, otherwise a spring. `point` and `from` refer to the origin of the
/// front vehicle, `to` refers to the origin of the rear vehicle.
struct Coupler {
  std::string name;
  std::array<std::string, 2> bodies;  // body of the front vehicle, body of the rear vehicle
  std::vector<int> gaps;              // the coupler is behind these vehicles of the train, from 0
  std::optional<multibody::Joint> joint;
  multibody::Spring spring;
};

/// One of several trains or groups of forces, or one whose speed or forces change over time or that runs to the left.
struct Course {
  std::string name;       // name of its block of options
  std::size_t first = 0;  // index of its first vehicle or force; the last is before the next course's first
  base::SpeedLaw speed;
  Drive drive = Drive::constant;
  std::shared_ptr<const track::Profile> profile;  // profile under its wheels; null: the profile of the track
  ForceVariation variation;                       // variation of each force of the group
  int track = 0;                                  // of beam::Torsion::tracks
};

/// The trains on the track. Without courses: one train that runs to the right at a constant speed.
struct Train {
  std::vector<int> vehicles;      // indices into a list of types, train by train, the front one first
  std::vector<double> positions;  // x of each origin at t = 0, m
  double speed = 0.0;             // m/s; with courses the greatest magnitude of all
  Drive drive = Drive::constant;  // with courses: free if one of them is free
  std::vector<Coupler> couplers;  // with gaps in the order of all vehicles
  std::vector<Course> courses;    // ascending in `first`
  int track = 0;                  // of beam::Torsion::tracks; unused with courses

  /// Whether vehicles run and the speed of all of them is prescribed.
  bool driven() const { return drive == Drive::constant && speed > 0.0; }
};

/// Moving forces and line loads. `lengths` and `moments` have one entry for each force or are empty: zeros.
struct MovingLoad {
  std::vector<double> forces;        // constant part of each force, N, downward; for a line load its resultant
  std::vector<double> positions;     // x of each force at t = 0, m; for a line load x of its centre
  double speed = 0.0;                // m/s; with courses the greatest magnitude of all
  std::vector<Course> courses = {};  // same meaning as in Train
  std::vector<double> lengths = {};  // length over which the force is spread uniformly, m; 0: concentrated
  std::vector<double> moments = {};  // N m, counter-clockwise, concentrated
  int track = 0;                     // same meaning as in Train
};

/// The course of vehicle or force `i`; null without courses.
template <class Moving>
const Course* course_of(const Moving& moving, std::size_t i) {
  const auto next = std::upper_bound(moving.courses.begin(), moving.courses.end(), i,
                                     [](std::size_t at, const Course& course) { return at < course.first; });
  return next == moving.courses.begin() ? nullptr : &*std::prev(next);
}

/// The track of vehicle or force `i`, of beam::Torsion::tracks.
template <class Moving>
int track_of(const Moving& moving, std::size_t i) {
  const Course* course = course_of(moving, i);
  return course == nullptr ? moving.track : course->track;
}

/// The speed law of vehicle or force `i` of a train or load.
template <class Moving>
base::SpeedLaw law_of(const Moving& moving, std::size_t i) {
  const Course* course = course_of(moving, i);
  return course == nullptr ? base::SpeedLaw(moving.speed) : course->speed;
}

/// The speed of vehicle or force `i` at t, m/s.
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

/// The length over which force `i` is spread, m; 0: concentrated.
inline double length_of(const MovingLoad& load, std::size_t i) { return load.lengths.empty() ? 0.0 : load.lengths[i]; }

/// The moment that acts together with force `i`, N m.
inline double moment_of(const MovingLoad& load, std::size_t i) { return load.moments.empty() ? 0.0 : load.moments[i]; }

/// Whether the load consists of constant concentrated forces, as a list of axle loads does.
inline bool only_axle_loads(const MovingLoad& load) {
  const auto some = [](const std::vector<double>& values) {
    return std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; });
  };
  return !some(load.lengths) && !some(load.moments) &&
         std::none_of(load.courses.begin(), load.courses.end(), [](const Course& c) { return c.variation.varies(); });
}

/// The highest frequency of the harmonics of all forces, Hz; 0 if there are none.
inline double highest_load_frequency(const MovingLoad& load) {
  double highest = 0.0;
  for (const Course& course : load.courses) highest = std::max(highest, course.variation.highest_frequency());
  return highest;
}

/// Force `i` at t, N, with its variation. The variation of a line load is in N/m.
inline double force_at(const MovingLoad& load, std::size_t i, double t) {
  const Course* course = course_of(load, i);
  if (course == nullptr || !course->variation.varies()) return load.forces[i];
  const double length = length_of(load, i);
  return load.forces[i] + (length > 0.0 ? length : 1.0) * course->variation.at(t);
}

/// Whether a vehicle's speed is prescribed, by its course or by the train.
inline Drive drive_of(const Train& train, std::size_t vehicle) {
  const Course* course = course_of(train, vehicle);
  return course == nullptr ? train.drive : course->drive;
}

}  // namespace traverse::train
