// All vehicles of a train with their wheels, on every rank: where they are, which piece of running surface each wheel
// is on, and the contact forces. A rank moves and evaluates its own vehicles, which are all unless ranks share them.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "beam/mesh.hpp"
#include "multibody/mechanism.hpp"
#include "track/touching.hpp"
#include "train/train_unit.hpp"
#include "train/vehicle_dynamics.hpp"
#include "train/wheel_on_track.hpp"
#include "traverse/train/vehicle.hpp"

namespace traverse::train {

/// One vehicle of the train, or several that couplers join.
struct MovingVehicle {
  explicit MovingVehicle(Unit unit);
  const std::string& name() const { return mechanism.model().name; }
  int freedom() const { return mechanism.freedom(); }
  /// From an error of p'' at the end of a step and p'' itself (freedom values each): the root of the mean square of its
  /// masses' accelerations' errors, over gravity and what these are.
  double step_error(const double* off, const double* pdd) const;
  multibody::Mechanism mechanism;
  multibody::MechanismState state;
  AnyDynamics dynamics;
  std::vector<Wheel> wheels;
  std::vector<contact::BodyContact> contacts;
  double weight = 0.0;        // N
  double scale = 0.0;         // N: forces are judged against it; the weight, or the mass times 1 m/s2 without gravity
  int offset = 0;             // of its independent coordinates in p
  int first_wheel = 0;        // in Fleet::wheels: one a wheel, then the further ones of its wheels
  int first_pair = 0;         // in Fleet::pairs
  std::vector<int> touching;  // its wheels and pairs, numbered as Fleet::contact does
  Eigen::VectorXd Q;          // generalized forces of the wheels, n
  bool rests = false;         // converged: Fleet::set and touch skip it

  void keep(base::Bytes& bytes) {
    bytes(mechanism, state, Q);
    dynamics->keep(bytes);
  }
};

/// A contact at the state last evaluated.
struct Contact {
  int vehicle = 0;
  int body = 0;
  int other_body = multibody::ground;
  contact::Law law;
  Touch touch;
  contact::Kinematics kinematics;
  contact::Force force;
  double approach_speed = 0.0;          // of the impact now going on or to come, m/s
  bool touched = false;                 // in some stage of the step as it was last taken
  bool released = false;                // its damper let go of a surface not yet back, whose energy is lost
  std::array<int, 2> slots = {-1, -1};  // of the patches' elements in Fleet::elements(); -1: ground
  double sign = 1.0;                    // of its force
  int active = 0;                       // the patch with the deepest penetration
  int slot() const { return slots[active]; }
  void keep(base::Bytes& bytes) {
    bytes(law, touch, kinematics, force, approach_speed, touched, released, slots, sign, active);
  }
};

/// Two bodies of a vehicle, or a body and the ground.
struct PairContact : Contact {
  contact::PairGeometry geometry;
};

/// A wheel on the track. A wheel sharper than the track's valleys, or one at a step of the surface, may touch at
/// several points (track::TouchingPoints): it has further entries for the other points, from left to right, and then
/// for what neighbouring points share, with the sign -1. Where it touches at fewer, the others have no candidates, a
/// negative penetration and no force. Nor has a wheel where there is no surface.
struct WheelContact : Contact {
  int wheel = 0;                 // of its vehicle
  std::array<Patch, 2> patches;  // the surface under the wheel, and the neighbour across a near kink
  int candidates = 1;
  bool turns = false;  // its body turns with it; else it has rolled by the distance gone over its radius
  double home = 0.0;   // angle (rad) or x (m) where it starts to roll
  int further = 0;     // index of the first further entry of this wheel; 0: none
  bool is_further = false;
  bool sharp = false;    // sharper than the track's valleys
  double divide = 0.0;   // sign -1: station of the minimum between the points, as it was found, m
  bool at_step = false;  // sign -1: there the surface steps; the patches are its two sides

  void keep(base::Bytes& bytes) {
    Contact::keep(bytes);
    bytes(patches, candidates, home, divide, at_step);
  }
};

struct WheelLoad {
  double normal = 0.0, tangential = 0.0;  // N
  double penetration = 0.0;               // m
};

class Fleet {
 public:
  Fleet() = default;
  /// mesh: of the beam that wheels run on, null for rigid ground alone, its surface at a height above its axis.
  /// yields_inside: whether what its elements yield between their nodes under wheels counts.
  /// frozen: every drive stands still at its place at t = 0, and a free train is held: for the static start.
  Fleet(const std::vector<Vehicle>& types, const Train& train, double gravity, bool frozen, const beam::Mesh* mesh,
        const track::Profile* profile, double surface_height, bool yields_inside = false);

  std::vector<MovingVehicle> vehicles;
  std::vector<Member> members;  // the vehicles of the train
  std::vector<CoupledGap> couplers;
  std::vector<WheelContact> wheels;
  std::vector<PairContact> pairs;

  /// All contacts, the wheels first.
  int contacts() const { return static_cast<int>(wheels.size() + pairs.size()); }
  Contact& contact(int i) { return const_cast<Contact&>(static_cast<const Fleet&>(*this).contact(i)); }
  const Contact& contact(int i) const {
    const std::size_t k = static_cast<std::size_t>(i);
    return k < wheels.size() ? static_cast<const Contact&>(wheels[k]) : pairs[k - wheels.size()];
  }
  const std::string& name(int contact) const;
  /// Whether a wheel has surface under it; bodies always may touch.
  bool may_touch(int contact) const {
    const auto k = static_cast<std::size_t>(contact);
    return k >= wheels.size() || wheels[k].candidates > 0;
  }
  /// The number of its vehicle in the train.
  int member(int contact) const;

  /// Makes the vehicles [first, past) this rank's own.
  void take(int first, int past);
  int first_own() const { return first_own_; }
  int past_own() const { return past_own_; }
  bool owns(const Contact& c) const { return c.vehicle >= first_own_ && c.vehicle < past_own_; }
  std::span<MovingVehicle> own() { return std::span(vehicles).subspan(first_own_, past_own_ - first_own_); }
  std::span<const MovingVehicle> own() const { return std::span(vehicles).subspan(first_own_, past_own_ - first_own_); }
  /// Of p: [first, past).
  std::pair<int, int> own_coordinates() const;

  int freedom() const { return freedom_; }
  const Wheel& wheel(const WheelContact& c) const { return vehicles[c.vehicle].wheels[c.wheel]; }
  /// The surface that it runs on.
  const track::Profile& profile(const Contact& c) const {
    const int course = course_[static_cast<std::size_t>(c.vehicle)];
    return course < 0 || !profiles_[static_cast<std::size_t>(course)] ? *profile_
                                                                      : *profiles_[static_cast<std::size_t>(course)];
  }
  Eigen::Vector3d coordinates(const Contact& c) const;
  Eigen::Vector3d velocities(const Contact& c) const;
  /// x of a contact's body and its rate, to be written where another rank tells them.
  double& x(const Contact& c) { return vehicles[c.vehicle].state.q[3 * static_cast<Eigen::Index>(c.body)]; }
  double& x_rate(const Contact& c) { return vehicles[c.vehicle].state.qd[3 * static_cast<Eigen::Index>(c.body)]; }
  /// Of a wheel's first entry: what all its points add up to, and the deepest penetration.
  WheelLoad load(const WheelContact& c) const;
  /// The first wheel (by its first entry) that has overlapped the track at more points than are modelled, and where.
  struct Crowded {
    int contact = -1;  // none
    double x = 0.0;
  };
  const Crowded& crowded() const { return crowded_; }
  /// Does a joint or driver hold the angle of the wheel's body? With a partition chosen.
  bool held(const WheelContact& c) const;
  /// All bodies and contacts to where they are in another fleet of the same train.
  void rest_where(const Fleet& other);
  /// All bodies to the velocities that the scene gives them.
  void start_moving();
  /// Lets wheels with friction that can turn freely begin without sliding, but for those whose turning speed is given.
  void let_wheels_roll();
  /// The body that has gone farther than anything held would since `start`, in words; empty: none.
  std::string lost_since(const Fleet& start) const;
  /// Mechanism::apply for a body of a vehicle of the train. InputError where that vehicle is taken as linear.
  void apply(int member, int body, const Eigen::Vector3d& action);
  /// A step is about to be taken, whose middle this is: where prescribed accelerations jump, they are those of this
  /// step. True when one has jumped.
  bool begin_step(double middle);
  /// Times at which actuators' tables have kinks, or prescribed accelerations jump, s.
  std::vector<double> kinks_of_actions() const;
  /// Counts the angles that wheels roll by from where they are now: for those out of round. A wheel whose body is free
  /// to turn, and does (by friction, or as its given speed says), is where its body's angle says; any other one rolls
  /// without sliding, however its body is held.
  void start_rolling();
  double rolled_angle(const WheelContact& c) const;

  /// Takes this rank's vehicles as linear about the state they are in at t = 0, evaluated, with the contact forces in
  /// Q: those that can be. Returns a line on that, and one for each kind of vehicle that cannot be, and why.
  std::vector<std::string> linearise();
  /// The state of this rank's vehicles as observers see it, with p'' (freedom values).
  void observe(const double* pdd);
  /// VehicleDynamics::defect, the largest of this rank's vehicles.
  double defect() const;

  /// Chooses every vehicle's independent coordinates at t and numbers them. From then on p counts from where the
  /// vehicles are now, moving on with the train and rolling on: small numbers, so that velocities found as shift times
  /// p keep their digits. Returns lines on redundant joints.
  std::vector<std::string> partition(double t);

  /// Whether the independent coordinates of a vehicle of this rank may have worn out.
  bool worn() const;
  /// Notes the states of this rank's vehicles, just evaluated, as accepted. Where independent coordinates have worn out
  /// others take their place: true then, and number() has to follow.
  bool accept();
  /// Numbers the vehicles' independent coordinates, as they are at t: see partition().
  void number(double t);

  /// Positions, velocities and forces of this rank's vehicles from p and p' (freedom values each), unless they are
  /// there. False where a mechanism cannot be assembled, which is stuck() then.
  bool set(double t, const double* p, const double* pd);
  /// Moves this rank's vehicles on by a small change of p (freedom values), and rate times it of p'.
  void shift(const double* change, double rate);
  /// Why the last evaluation of this rank's vehicles failed; empty where it did not: a joint jams, or one cannot be
  /// assembled.
  std::string trouble() const;
  /// p and p' (freedom values each) of the vehicles' q and q' at t.
  void coordinates_of_state(double t, double* p, double* pd) const;

  /// Arcs that have gone round the end of a line are on its other side from then on.
  void record_sides();

  /// Finds the patches under the wheels and the list of beam elements in touch.
  void place_wheels();
  /// Whether the wheels of this rank's vehicles are still on these patches.
  bool wheels_in_place() const;
  const std::vector<int>& elements() const { return elements_; }

  /// Contact geometry of this rank's vehicles from the elements' unknowns v and rates w (2*per_node an element of
  /// elements()). False where a contact is driven through.
  bool touch(int per_node, const double* v, const double* w);
  /// Forces from the kinematics held in the contacts.
  void contact_forces();
  /// Q of this rank's vehicles from the contact forces.
  void contact_loads();
  /// Adds a contact's forces to its vehicle's Q.
  static void add_load(const Contact& contact, double normal, double tangential, Eigen::VectorXd& Q);
  /// Contact forces as nodal values of the elements in touch, 2*per_node each, on the beam.
  void element_loads(int per_node, std::vector<double>& loads) const;
  /// The same from the wheels' normal forces and x alone, before the geometry is known: straight down.
  void expected_loads(int per_node, std::vector<double>& loads) const;
  /// Whether a contact carries force, and its penetration; of a wheel with several points all of them and the deepest.
  /// The further points of a wheel count with their first.
  bool touches(int contact) const;
  const contact::Kinematics& kinematics(int contact) const;
  /// Whether it is one of several points at which a wheel may touch where it is.
  bool has_points(int contact) const;
  bool has_points(const WheelContact& c) const;
  /// How far from its centre a wheel may touch the beam, m.
  double reach(const WheelContact& c) const;
  /// Ascending stations, m: while a wheel is between two of them its patches are found in the same way.
  std::vector<double> borders_of_patches(const WheelContact& c) const;
  /// How long the impact lasts that a contact now begins, the bodies of its vehicle alone taking part, s.
  double impact_duration(int contact);
  /// Power lost in contact damping and friction at this rank's vehicles, W.
  double contact_dissipation() const;
  /// Energy stored in the contacts, J.
  double contact_potential() const;
  /// Powers of this rank's vehicles, W.
  multibody::MechanismPowers powers() const;
  /// Energies of all vehicles, J.
  multibody::MechanismEnergy energy() const;

  /// Collective. What changes with time; owners: the rank of each vehicle where they are dealt out.
  void keep(base::Archive& archive, const std::vector<int>& owners);

 private:
  void add_patch(WheelContact& c, int element, double start, double low, double high);
  void find_patches(WheelContact& c, double x, double from, double to, double low, double high);
  void find_sides(WheelContact& c, double step);
  void add_ground(WheelContact& c, bool before, double x, double low, double high);
  std::span<const double> steps_near(const WheelContact& c) const;
  void find_points(WheelContact& c);
  void take_away(WheelContact& c);
  bool touch_patches(WheelContact& c, int per_node, const double* v, const double* w, Find find);
  bool touch_points(WheelContact& c, int per_node, const double* v, const double* w);
  void lose(WheelContact& c) const;
  WheelContact& point(const WheelContact& first, int i) {
    return i == 0 ? wheels[index(first)] : further(first, i - 1);
  }
  WheelContact& between(const WheelContact& first, int i) { return further(first, track::most_points - 1 + i); }
  WheelContact& further(const WheelContact& first, int i) {
    return wheels[static_cast<std::size_t>(first.further + i)];
  }
  std::size_t index(const WheelContact& c) const { return static_cast<std::size_t>(&c - wheels.data()); }
  void add_shape(WheelContact& c) const;
  void add_pairs(int vehicle);
  bool touch(PairContact& pair) const;

  const beam::Mesh* mesh_ = nullptr;
  const track::Profile* profile_ = nullptr;
  int freedom_ = 0;
  int first_own_ = 0, past_own_ = 0;
  std::vector<double> speeds_;                                   // of each of `vehicles` at t = 0, m/s
  std::vector<int> course_;                                      // of each; -1: none
  std::vector<std::shared_ptr<const track::Profile>> profiles_;  // of the courses; null: profile_
  bool jumps_ = false;                                           // prescribed accelerations do
  bool frozen_ = false;
  int stuck_ = -1;
  double surface_height_ = 0.0;
  bool yields_inside_ = false;
  Crowded crowded_;
  std::vector<int> elements_;
  std::vector<double> home_, cruise_;        // coordinates = home + cruise*t + p
  std::vector<double> position_, velocity_;  // independent ones of all vehicles, as they were set last
  double time_ = 0.0;                        // when
  bool is_set_ = false;
};

}  // namespace traverse::train
