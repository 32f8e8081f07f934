// All vehicles of a train with their wheels, the same on every rank: where they are, which piece of running surface
// each wheel is on, and the contact forces.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <string>
#include <vector>

#include "traverse/beam/mesh.hpp"
#include "traverse/coupling/vehicle.hpp"
#include "traverse/coupling/wheel_on_track.hpp"
#include "traverse/multibody/mechanism.hpp"

namespace traverse::coupling {

/// One vehicle of the train.
struct MovingVehicle {
  MovingVehicle(multibody::MechanismModel model, std::vector<Wheel> its_wheels);
  multibody::Mechanism mechanism;
  multibody::MechanismState state;
  std::vector<Wheel> wheels;
  double weight = 0.0;   // N
  double scale = 0.0;    // N: forces are judged against it; the weight, or the mass times 1 m/s2 without gravity
  int offset = 0;        // of its independent coordinates in p
  int first_wheel = 0;   // in the list of all wheels
  Eigen::VectorXd Q;     // generalized forces of the wheels, n
};

/// A wheel's contact at the state last evaluated.
struct WheelContact {
  int vehicle = 0;
  int wheel = 0;                        // of its vehicle
  std::array<Patch, 2> patches;         // the surface under the wheel, and the neighbour across a near kink
  std::array<int, 2> slots = {-1, -1};  // of the patches' elements in Fleet::elements(); -1: ground
  int candidates = 1;
  int active = 0;  // the patch with the deepest penetration
  Touch touch;
  contact::Kinematics kinematics;
  contact::Force force;
  double approach_speed = 0.0;  // of the impact now going on, m/s
  bool turns = false;           // its body turns with it; else it has rolled by the distance gone over its radius
  double home = 0.0;            // angle (rad) or x (m) where it starts to roll
  int slot() const { return slots[active]; }
};

class Fleet {
 public:
  Fleet() = default;
  /// mesh: of the beam that wheels run on, null for rigid ground alone, its surface at a height above its axis.
  /// frozen: every drive stands still at its place at t = 0, and a free train is held: for the static start.
  Fleet(const std::vector<Vehicle>& types, const Train& train, double gravity, bool frozen, const beam::Mesh* mesh,
        const track::Profile* profile, double surface_height);

  std::vector<MovingVehicle> vehicles;
  std::vector<WheelContact> wheels;

  int freedom() const { return freedom_; }
  const Wheel& wheel(const WheelContact& c) const { return vehicles[c.vehicle].wheels[c.wheel]; }
  int body(const WheelContact& c) const { return wheel(c).body; }
  Eigen::Vector3d coordinates(const WheelContact& c) const;
  Eigen::Vector3d velocities(const WheelContact& c) const;
  /// Does a joint or driver hold the angle of the wheel's body? With a partition chosen.
  bool held(const WheelContact& c) const;
  /// Counts the angles that wheels roll by from where they are now: for those out of round. A wheel whose body is free
  /// to turn, and does (by friction, or as its given speed says), is where its body's angle says; any other one rolls
  /// without sliding, however its body is held.
  void start_rolling();
  double rolled_angle(const WheelContact& c) const;

  /// Chooses every vehicle's independent coordinates at t and numbers them. From then on p counts from where the
  /// vehicles are now, moving on with the train and rolling on: small numbers, so that velocities found as shift times
  /// p keep their digits. Returns lines on redundant joints.
  std::vector<std::string> partition(double t);

  /// Whether some vehicle's independent coordinates may have worn out.
  bool worn() const;
  /// Notes the vehicles' states, just evaluated, as accepted at t. Where independent coordinates have worn out others
  /// take their place: true then, and p has a new meaning.
  bool accept(double t);

  /// Positions, velocities and forces of all vehicles from p and p' (freedom values each). False where a mechanism
  /// cannot be assembled, which is stuck() then.
  bool set(double t, const double* p, const double* pd);
  /// The vehicle that could not be assembled when set() failed last; null when it did not.
  const MovingVehicle* stuck() const { return stuck_ < 0 ? nullptr : &vehicles[static_cast<std::size_t>(stuck_)]; }
  /// p and p' (freedom values each) of the vehicles' q and q' at t.
  void coordinates_of_state(double t, double* p, double* pd) const;

  /// Finds the patches under the wheels and the list of beam elements in touch.
  void place_wheels();
  bool wheels_in_place() const;
  const std::vector<int>& elements() const { return elements_; }

  /// Contact geometry from the elements' unknowns v and rates w (2*per_node an element of elements()).
  bool touch(int per_node, const double* v, const double* w);
  /// Forces from the kinematics held in `wheels`.
  void contact_forces();
  /// The vehicles' Q from the contact forces.
  void wheel_loads();
  /// Contact forces as nodal values of the elements in touch, 2*per_node each, on the beam.
  void element_loads(int per_node, std::vector<double>& loads) const;
  /// Power lost in contact damping and friction, W.
  double contact_dissipation() const;
  double contact_potential() const;

 private:
  void number(double t);
  void add_patch(WheelContact& c, int element, double low, double high);
  void add_shape(WheelContact& c) const;

  const beam::Mesh* mesh_ = nullptr;
  const track::Profile* profile_ = nullptr;
  int freedom_ = 0;
  double speed_ = 0.0;
  bool frozen_ = false;
  int stuck_ = -1;
  double surface_height_ = 0.0;
  std::vector<int> elements_;
  std::vector<double> home_, cruise_;        // coordinates = home + cruise*t + p
  std::vector<double> position_, velocity_;  // of one vehicle
};

}  // namespace traverse::coupling
