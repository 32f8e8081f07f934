// A planar mechanism as the user describes it: bodies, joints, drivers, force elements (section 4 of the paper). Units
// are SI; x is along the track, y upward, angles counter-clockwise in rad. All points are in the global frame at t = 0,
// with every body at its `position`; `ground` is the fixed frame.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "traverse/base/force_law.hpp"
#include "traverse/base/time_function.hpp"
#include "traverse/multibody/joint_type.hpp"

namespace traverse::multibody {

inline constexpr int ground = -1;  // a body index

/// A rigid body. Its three coordinates are x and y of its centre of mass and its angle.
struct Body {
  std::string name;
  double mass = 0.0;                                   // kg, > 0
  double inertia = 0.0;                                // kg m2 about the centre of mass, > 0
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // x, y, phi at t = 0
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // rates of x, y, phi at t = 0
};

/// Friction along the axis of a sliding joint: (coefficient*|normal force| + force) tanh(sliding speed /
/// transition_speed), against the sliding.
struct SlidingFriction {
  double coefficient = 0.0;        // friction coefficient of the joint's normal force, 1
  double force = 0.0;              // N, independent of the normal force
  double transition_speed = 0.01;  // m/s
  bool acts() const { return coefficient > 0.0 || force > 0.0; }
};

struct Joint {
  std::string name;
  JointType type = JointType::revolute;          // determines which of the following members are used
  std::array<int, 2> bodies = {ground, ground};  // the reported reaction acts on the second one
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis = Eigen::Vector2d::UnitY();  // fixed in the first body
  Eigen::Vector2d from = Eigen::Vector2d::Zero();   // on the first body
  Eigen::Vector2d to = Eigen::Vector2d::Zero();     // on the second body
  SlidingFriction friction = {};
  std::array<double, most_joint_numbers> numbers = {};  // additional numbers of the type
};

/// A rheonomic constraint: one coordinate of one body is a prescribed function of time.
struct Driver {
  std::string name;
  int body = 0;
  int coordinate = 0;  // 0 x, 1 y, 2 phi
  base::TimeFunction value;
};

/// Spring-damper between two points: force = preload + stiffness*(length - free_length) + damping*rate, positive in
/// tension. At most one of free_length and preload may be set. Without both, the spring has no force in the geometry at
/// t = 0. A preload is the force (positive in tension) in the geometry at t = 0. With a law: force = law(length -
/// free_length, rate).
struct Spring {
  std::string name;
  std::array<int, 2> bodies = {ground, ground};
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  // on the first body
  Eigen::Vector2d to = Eigen::Vector2d::Zero();    // on the second body
  double stiffness = 0.0;                          // N/m
  double damping = 0.0;                            // N s/m
  std::optional<double> free_length;               // m
  std::optional<double> preload;                   // N
  std::optional<base::ForceLaw> law;               // instead of stiffness and damping, over the elongation
  std::optional<base::TimeFunction> winding;       // m, added to the free length over time: a rope on a winch
};

inline constexpr int most_bodies_of_a_rope = 8;

/// A rope through points on bodies, in their order: pulleys without friction, whose falls share one tension. It only
/// pulls: tension = stiffness*(length - unstretched length) + damping*rate, with `axial_rigidity` EA instead of the
/// stiffness EA over the unstretched length. At most one of free_length and preload may be set; without both, the rope
/// has no force in the geometry at t = 0. A preload is the tension in the geometry at t = 0. The last point may be
/// where the rope runs onto a drum, on the body that carries the drum: a turn of the drum relative to this body takes
/// up drum_radius times its angle.
struct Rope {
  std::string name;
  std::vector<int> bodies;              // of the points, at most most_bodies_of_a_rope different ones with the drum
  std::vector<Eigen::Vector2d> points;  // at least two, m
  double stiffness = 0.0;               // N/m
  double axial_rigidity = 0.0;          // N
  double damping = 0.0;                 // N s/m
  std::optional<double> free_length;    // m, > 0
  std::optional<double> preload;        // N, >= 0
  std::optional<base::TimeFunction> winding;  // m, added to the free length over time: a rope on a winch
  int drum = ground;                          // ground: no drum
  double drum_radius = 0.0;                   // m, positive if the drum takes rope up as it turns counter-clockwise
};

/// The length of the path and the unstretched length at t = 0, m.
double path_length(const Rope& rope);
double unstretched_length(const Rope& rope);

/// Moment on the second body = -stiffness*(phi_2 - phi_1 - free_angle) - damping*(rate), opposite on the first.
/// With a law: -law(phi_2 - phi_1 - free_angle, rate).
struct TorsionSpring {
  std::string name;
  std::array<int, 2> bodies = {ground, ground};
  double stiffness = 0.0;                            // N m/rad
  double damping = 0.0;                              // N m s/rad
  std::optional<double> free_angle;                  // rad; empty: the angle at t = 0
  std::optional<base::ForceLaw> law = std::nullopt;  // instead of stiffness and damping, over the twist
};

/// A force at the centre of mass of `body` and a moment on it over time. The opposite force acts at the centre of mass
/// of `reaction_body`, with the opposite moment; the moment due to the offset of both forces is not balanced.
struct Actuator {
  std::string name;
  int body = 0;
  int reaction_body = ground;
  std::array<base::TimeFunction, 3> action;  // fx, fy (N), moment (N m)
};

struct MechanismModel {
  std::string name;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Driver> drivers;
  std::vector<Spring> springs;
  std::vector<TorsionSpring> torsion_springs;
  std::vector<Rope> ropes;
  std::vector<Actuator> actuators;
  double gravity = 9.81;  // m/s2, along -y
  double gradient = 0.0;  // tan of the angle of the x axis: gravity has the component -gradient*gravity along x
};

// Names that were in this namespace before their folder had one, for programs that use them.
using base::ForceLaw;
using base::Polyline;
using base::Side;
using base::stored_energy;
using base::Tension;
using base::tension;

}  // namespace traverse::multibody
