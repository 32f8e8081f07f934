// All vehicles of a train with their wheels, on every rank: their positions, the piece of running surface under each
// wheel, and the contact forces. A rank moves and evaluates its own vehicles: all, unless ranks share them.
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

/// A unit: one vehicle of the train, or several vehicles joined by couplers. A Member is one vehicle of the train.
struct MovingVehicle {
  explicit MovingVehicle(Unit unit);
  const std::string& name() const { return mechanism.model().name; }
  int freedom() const { return mechanism.freedom(); }
  /// From an error of p'' at the end of a step and p'' itself (freedom values each): the root mean square of the errors
  /// of its masses' accelerations, over gravity plus these accelerations.
  double step_error(const double* error_of_pdd, const double* pdd);
  multibody::Mechanism mechanism;
  multibody::MechanismState state;
  AnyDynamics dynamics;
  std::vector<Wheel> wheels;
  std::vector<contact::BodyContact> contacts;
  std::vector<int> drives;              // drivers of its mechanism that prescribe the train's speed
  base::SpeedLaw speed;                 // this speed
  base::TimeFunction travel{0.0, 1.0};  // s of the steady motion: the time, or the distance of a changing speed
  double weight = 0.0;                  // N
  double scale = 0.0;                   // N: scale of forces; the weight, or without gravity the mass times 1 m/s2
  int offset = 0;                       // index of its first independent coordinate in p
  int first_wheel = 0;                  // in Fleet::wheels: one for each wheel, then the further ones of its wheels
  int first_pair = 0;                   // in Fleet::pairs
  std::vector<int> touching;            // its wheels and pairs, by the indices of Fleet::contact
  Eigen::VectorXd Q;                    // generalized forces of the wheels, n
  bool converged = false;               // its iteration of the stage has converged; Fleet::set and touch skip it

  void keep(base::Bytes& bytes) {
    bytes(mechanism, state, Q);
    dynamics->keep(bytes);
  }
};

/// A contact at the state evaluated last.
struct Contact {
  int vehicle = 0;  // index of the unit in Fleet::vehicles; Fleet::member returns the vehicle of the train
  int body = 0;
  int other_body = multibody::ground;
  contact::Law law;
  Touch touch;
  contact::Kinematics kinematics;
  contact::Force force;
  double approach_speed = 0.0;          // approach speed of the present or next impact, m/s
  bool touched = false;                 // with a force in some stage of the last step
  bool lifted = false;                  // without a force in some stage of the last step
  bool released = false;                // opened by its damper while compressed; the elastic energy is lost
  std::array<int, 2> slots = {-1, -1};  // indices of the patches' elements in Fleet::elements(); -1: ground
  double factor = 1.0;                  // of its force
  int active = 0;                       // the patch with the deepest penetration
  int slot() const { return slots[active]; }
  void keep(base::Bytes& bytes) {
    bytes(law.local_compliance, touch, kinematics, force, approach_speed, touched, lifted, released, slots, factor,
          active);
  }
};

/// Two bodies of a vehicle, or a body and the ground.
struct PairContact : Contact {
  contact::PairGeometry geometry;
};

/// A wheel on the track. A wheel with a radius larger than that of the track's valleys, or one at a jump of the
/// surface's height, may touch at several points (track::TouchingPoints). It has further entries: the other points from
/// left to right, then the common overlaps of neighbouring points, whose forces are subtracted (factor -1), then the
/// right ends at jumps in height. Unused entries have no candidates, a negative penetration and no force; so has a
/// wheel without a surface under it.
///
/// At a jump in height the common overlap is that of the lower one of the two ends: it has the potential
/// share*U(left end) + (1 - share)*U(right end), and the share is 1 if the left end is lower, 0 if the right one is.
/// Between two level ends any share is an equilibrium of the contact, and the beams that they belong to determine it.
/// An entry for either end has these forces.
struct WheelContact : Contact {
  int wheel = 0;                 // index of the wheel in its vehicle
  int track = 0;                 // of beam::Torsion::tracks
  std::array<Patch, 2> patches;  // the surface under the wheel, and beyond a near kink
  int candidates = 1;
  bool turns = false;        // it turns with its body; otherwise its angle is the distance over its radius
  double roll_origin = 0.0;  // initial angle (rad) or x (m) of the rolling
  int further = 0;           // index of the first further entry of this wheel; 0: none
  bool is_further = false;
  bool may_touch_several_points = false;  // its radius is larger than that of the track's valleys
  // Of a common overlap: station of the minimum between the points, m; whether the height jumps there, so that this is
  // the entry of the left end; the share of the left end, whether it is held, and the height of the right end above the
  // left one, m.
  double minimum_station = 0.0;
  bool at_height_jump = false;
  double share = 1.0;
  bool share_held = false;
  double jump = 0.0;

  void keep(base::Bytes& bytes) {
    Contact::keep(bytes);
    bytes(patches, candidates, roll_origin, minimum_station, at_height_jump, share, jump);
  }
};

/// The force of a contact at its kinematics.
contact::Force force_of(const Contact& contact);

/// Two ends of surfaces at a smaller distance are level, m.
inline constexpr double level = 1e-9;

/// The number of further entries of a wheel.
inline constexpr int further_entries = 3 * (track::most_points - 1);

struct WheelLoad {
  double normal = 0.0, tangential = 0.0;  // N
  double penetration = 0.0;               // m
};

class Fleet {
 public:
  Fleet() = default;
  /// mesh: of the beam that wheels run on, null for rigid ground only; surface_height: of its surface above its axis.
  /// uses_local_compliance: whether wheels deflect elements between their nodes. frozen: for the static start, every
  /// drive remains at its position at t = 0, and a free train is fixed.
  Fleet(const std::vector<Vehicle>& types, const Train& train, double gravity, bool frozen, const beam::Mesh* mesh,
        const track::Profile* profile, double surface_height, bool uses_local_compliance = false);

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
  /// Whether a wheel has a surface under it; bodies may always touch.
  bool may_touch(int contact) const {
    const auto k = static_cast<std::size_t>(contact);
    return k >= wheels.size() || wheels[k].candidates > 0;
  }
  /// The index of the contact's vehicle in `members`.
  int member(int contact) const;

  /// Makes the vehicles [first, past) those of this rank.
  void set_own(int first, int past);
  int first_own() const { return first_own_; }
  int past_own() const { return past_own_; }
  bool owns(const Contact& c) const { return c.vehicle >= first_own_ && c.vehicle < past_own_; }
  std::span<MovingVehicle> own() { return std::span(vehicles).subspan(first_own_, past_own_ - first_own_); }
  std::span<const MovingVehicle> own() const { return std::span(vehicles).subspan(first_own_, past_own_ - first_own_); }
  /// The range of this rank's coordinates in p: [first, past).
  std::pair<int, int> own_coordinates() const;

  int freedom() const { return freedom_; }
  const Wheel& wheel(const WheelContact& c) const { return vehicles[c.vehicle].wheels[c.wheel]; }
  /// The surface under the contact's vehicle.
  const track::Profile& profile(const Contact& c) const {
    const int course = course_[static_cast<std::size_t>(c.vehicle)];
    return course < 0 || !profiles_[static_cast<std::size_t>(course)] ? *profile_
                                                                      : *profiles_[static_cast<std::size_t>(course)];
  }
  Eigen::Vector3d coordinates(const Contact& c) const;
  Eigen::Vector3d velocities(const Contact& c) const;
  /// x of a contact's body and its rate, writable for values from another rank.
  double& x(const Contact& c) { return vehicles[c.vehicle].state.q[3 * static_cast<Eigen::Index>(c.body)]; }
  double& x_rate(const Contact& c) { return vehicles[c.vehicle].state.qd[3 * static_cast<Eigen::Index>(c.body)]; }
  /// For a wheel's first entry: the sum of the forces of all its points, and the deepest penetration.
  WheelLoad load(const WheelContact& c) const;
  /// The first wheel (by its first entry) that has overlapped the track at more points than the model has, and its
  /// position.
  struct UnmodelledContact {
    int contact = -1;  // none
    double x = 0.0;
  };
  const UnmodelledContact& unmodelled_contact() const { return unmodelled_contact_; }
  /// Whether a joint or driver constrains the angle of the wheel's body. Requires a partition.
  bool rotation_constrained(const WheelContact& c) const;
  /// Gives every point of the placed wheels the penetration of an equal share of the vehicle's weight.
  void set_static_penetrations();
  /// Copies the positions of all bodies and contacts from another fleet of the same train.
  void copy_positions(const Fleet& other);
  /// Sets the velocities of all bodies to those of the scene.
  void start_moving();
  /// Lets wheels with friction that can turn freely start without sliding, except those with a given turning speed.
  void set_rolling_speeds();
  /// The unsupported body with the largest displacement since `start`, in words; empty: none.
  std::string unsupported_body(const Fleet& start) const;
  /// Calls Mechanism::apply for a body of a vehicle of the train. InputError if that vehicle is linearised.
  void apply(int member, int body, const Eigen::Vector3d& action);
  /// Called before a step, with the time of its middle: selects the prescribed motions of this step where they jump.
  /// True if one has jumped.
  bool begin_step(double middle);
  /// Times at which rates or accelerations of drivers and winches jump, s.
  std::vector<double> kinks_of_motions() const;
  /// These times, and those at which actuators' tables have kinks, s.
  std::vector<double> kinks_of_actions() const;
  /// Starts to count the rolling angles of wheels out of round. If a wheel's body is free to turn and turns (by
  /// friction, or with a given speed), the angle is that of the body; any other wheel rolls without sliding.
  void start_rolling();
  double rolled_angle(const WheelContact& c) const;

  /// Linearises this rank's vehicles about their evaluated state at t = 0, with the contact forces in Q, if possible.
  /// Returns a line on that, and one for each kind of vehicle that cannot be linearised, with the reason.
  std::vector<std::string> linearise();
  /// Computes the observed state of this rank's vehicles, with p'' (freedom values).
  void observe(const double* pdd);
  /// The largest LinearDynamics::linearisation_residual of this rank's vehicles.
  double linearisation_residual() const;

  /// Selects every vehicle's independent coordinates at t and numbers them. From then on p is measured from a
  /// steady motion that starts at the present state (travelling with the train, wheels rolling): p remains small, and
  /// shift times p has little rounding error. Returns lines on redundant joints.
  std::vector<std::string> partition(double t);

  /// Whether the independent coordinates of a vehicle of this rank may be badly conditioned.
  bool badly_conditioned();
  /// The vertical displacement (m) and velocity (m/s) of the rigid ground before and behind the beam.
  void move_ground(std::array<double, 2> before, std::array<double, 2> behind) { ground_ = {before, behind}; }
  /// The power of moving ground on the wheels, W.
  double power_of_ground() const;
  /// Accepts the states of this rank's vehicles, which were just evaluated. Replaces badly conditioned independent
  /// coordinates: then the result is true, and assign_coordinates() must follow.
  bool accept();
  /// Assigns indices in p to the vehicles' independent coordinates, with their state at t: see partition().
  void assign_coordinates(double t);

  /// Sets positions, velocities and forces of this rank's vehicles from p and p' (freedom values each), unless they are
  /// set already. False if a mechanism cannot be assembled.
  bool set(double t, const double* p, const double* pd);
  /// Moves this rank's vehicles by a small change of p (freedom values), and rate times it of p'.
  void shift(const double* change, double rate);
  /// The reason why the last evaluation of this rank's vehicles failed: a jammed joint or a mechanism that cannot be
  /// assembled; empty if it did not fail.
  std::string failure_reason() const;
  /// p and p' (freedom values each) for the vehicles' q and q' at t.
  void coordinates_of_state(double t, double* p, double* pd) const;

  /// Stores for every arc-line contact on which side of the line the arc is; the side can change only around the line's
  /// end.
  void record_sides();

  /// Determines the patches under the wheels and the list of beam elements under wheels.
  void place_wheels();
  /// Whether the wheels of this rank's vehicles are on these patches.
  bool wheels_in_place() const;
  const std::vector<int>& elements() const { return elements_; }

  /// Contact geometry of this rank's vehicles from the elements' unknowns v and rates w (2*per_node for each element of
  /// elements()). False if a body has passed through a surface.
  bool touch(int per_node, const double* v, const double* w);
  /// Computes the contact forces from the kinematics stored in the contacts.
  void contact_forces();
  /// Computes Q of this rank's vehicles from the contact forces.
  void contact_loads();
  /// Adds a contact's forces to its vehicle's Q.
  static void add_load(const Contact& contact, double normal, double tangential, Eigen::VectorXd& Q);
  /// Contact forces as nodal values of the elements under wheels, 2*per_node each, on the beam.
  void element_loads(int per_node, std::vector<double>& loads) const;
  /// The same, vertical only, from the wheels' normal forces and x, before the geometry is known.
  void expected_loads(int per_node, std::vector<double>& loads) const;
  /// Whether a contact has a force, and its penetration; for a wheel with several points the sum and the deepest one.
  /// The further points of a wheel belong to its first entry.
  bool touches(int contact) const;
  const contact::Kinematics& kinematics(int contact) const;
  /// What the opening and closing of a contact are located by: its kinematics. A guided wheel (law two_sided) keeps its
  /// contact until it passes an end of the beam without a surface beyond: its penetration is the distance to that end.
  contact::Kinematics event_kinematics(int contact) const;
  /// Whether the contact is one of several possible points of a wheel at its position.
  bool has_points(int contact) const;
  bool has_points(const WheelContact& c) const;
  /// The largest distance from its centre at which a wheel may touch the beam, m.
  double reach(const WheelContact& c) const;
  /// Ascending stations, m: between two of them the rule for a wheel's patches is the same.
  std::vector<double> borders_of_patches(const WheelContact& c) const;
  /// Duration of the impact that begins at a contact, with the bodies of its vehicle only, s.
  double impact_duration(int contact);
  /// Power lost in contact damping and friction at this rank's vehicles, W.
  double contact_dissipation() const;
  /// Energy stored in the contacts, J.
  double contact_potential() const;
  /// Powers of this rank's vehicles, W.
  base::Powers powers() const;
  /// Energies of all vehicles, J.
  multibody::MechanismEnergy energy() const;

  /// Collective. Writes or reads the time-dependent state; owners: the rank of each vehicle if ranks share them.
  void keep(base::Archive& archive, const std::vector<int>& owners);

 private:
  void add_patch(WheelContact& c, int element, double start, double low, double high);
  void find_patches(WheelContact& c, double x, double from, double to, double low, double high);
  void set_end(WheelContact& c, double step, bool left);
  void add_ground(WheelContact& c, bool before, double x, double low, double high);
  std::span<const double> height_jumps_near(const WheelContact& c) const;
  void find_points(WheelContact& c);
  void reset_contact(WheelContact& c);
  double static_penetration(const WheelContact& c) const;
  bool touch_patches(WheelContact& c, int per_node, const double* v, const double* w, Find find);
  bool touch_points(WheelContact& c, int per_node, const double* v, const double* w);
  bool touch_jump(WheelContact& left, WheelContact& right, WheelContact& left_end, WheelContact& right_end,
                  int per_node, const double* v, const double* w);
  void clear_touch(WheelContact& c) const;
  bool has_left_guide(const WheelContact& c) const;
  WheelContact& point(const WheelContact& first, int i) {
    return i == 0 ? wheels[index(first)] : further_entry(first, i - 1);
  }
  WheelContact& shared_entry(const WheelContact& first, int i) {
    return further_entry(first, track::most_points - 1 + i);
  }
  WheelContact& right_end(const WheelContact& first, int i) {
    return further_entry(first, 2 * (track::most_points - 1) + i);
  }
  WheelContact& further_entry(const WheelContact& first, int i) {
    return wheels[static_cast<std::size_t>(first.further + i)];
  }
  std::size_t index(const WheelContact& c) const { return static_cast<std::size_t>(&c - wheels.data()); }
  void add_shape(WheelContact& c) const;
  void add_pairs(int vehicle);
  void measure_by_distance(MovingVehicle& vehicle);
  bool touch(PairContact& pair) const;

  const beam::Mesh* mesh_ = nullptr;
  const track::Profile* profile_ = nullptr;
  int freedom_ = 0;
  int first_own_ = 0, past_own_ = 0;
  std::vector<double> speeds_;  // speed of each of `vehicles` at t = 0, m/s
  std::array<std::array<double, 2>, 2> ground_{};
  std::vector<int> course_;  // index of the course (one of several trains) of each of `vehicles`; -1: none
  std::vector<std::shared_ptr<const track::Profile>> profiles_;  // for each course; null: profile_
  bool has_kinks_ = false;                                       // whether a prescribed motion has kinks
  bool frozen_ = false;
  int failed_ = -1;
  double surface_height_ = 0.0;
  bool uses_local_compliance_ = false;
  UnmodelledContact unmodelled_contact_;
  std::vector<int> elements_;
  std::vector<double> origin_, steady_rate_;  // coordinates = origin + steady rate*s(t) + p, s: MovingVehicle::travel
  std::vector<double> position_, velocity_;   // independent coordinates of all vehicles, as set last
  double time_ = 0.0;                         // time of position_ and velocity_, s
  bool is_set_ = false;
};

}  // namespace traverse::train
