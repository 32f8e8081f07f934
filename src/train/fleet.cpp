// Creates mechanisms, wheel contacts and pairs of bodies from the train, numbers the independent coordinates of all
// vehicles, and sets their positions and velocities.
#include "train/fleet.hpp"

#include <algorithm>

#include "linear_dynamics.hpp"
#include "multibody_dynamics.hpp"

namespace traverse::train {
namespace {

constexpr double free_to_turn = 1e-9;  // m: arm of a joint about the wheel's centre

}  // namespace

MovingVehicle::MovingVehicle(Unit unit)
    : mechanism(std::move(unit.mechanism)),
      state(mechanism.make_state()),
      dynamics(std::make_unique<MultibodyDynamics>()),
      wheels(std::move(unit.wheels)),
      contacts(std::move(unit.contacts)),
      drives(std::move(unit.drives)),
      speed(std::move(unit.speed)) {
  Q.setZero(mechanism.coordinates());
  double mass = 0.0;
  for (const multibody::Body& b : mechanism.model().bodies) mass += b.mass;
  weight = mass * mechanism.model().gravity;
  scale = mass * std::max(1.0, mechanism.model().gravity);
}

Fleet::Fleet(const std::vector<Vehicle>& types, const Train& train, double gravity, bool frozen, const beam::Mesh* mesh,
             const track::Profile* profile, double surface_height, bool uses_local_compliance)
    : mesh_(mesh),
      profile_(profile),
      frozen_(frozen),
      surface_height_(surface_height),
      uses_local_compliance_(uses_local_compliance) {
  AssembledTrain assembled = assemble(types, train, gravity, frozen);
  members = std::move(assembled.members);
  speeds_.assign(assembled.units.size(), 0.0);
  for (const Course& course : train.courses) profiles_.push_back(course.profile);
  course_.assign(assembled.units.size(), -1);
  std::vector<int> track(assembled.units.size(), 0);
  for (std::size_t i = members.size(); i-- > 0;) {
    const auto unit = static_cast<std::size_t>(members[i].unit);
    if (!frozen) speeds_[unit] = speed_of(train, i, 0.0);
    track[unit] = track_of(train, i);
    if (const Course* course = course_of(train, i)) course_[unit] = static_cast<int>(course - train.courses.data());
  }
  couplers = std::move(assembled.couplers);
  for (std::size_t k = 0; k < assembled.units.size(); ++k) {
    vehicles.emplace_back(std::move(assembled.units[k]));
    MovingVehicle& vehicle = vehicles.back();
    vehicle.first_wheel = static_cast<int>(wheels.size());
    for (std::size_t i = 0; i < vehicle.wheels.size(); ++i) {
      WheelContact c;
      c.vehicle = static_cast<int>(k);
      c.wheel = static_cast<int>(i);
      c.track = track[k];
      c.body = vehicle.wheels[i].body;
      c.law = vehicle.wheels[i].law;
      c.kinematics.penetration = static_penetration(c);
      wheels.push_back(c);
    }
    for (std::size_t i = 0; i < vehicle.wheels.size(); ++i) {
      WheelContact c;
      c.vehicle = static_cast<int>(k);
      c.may_touch_several_points = track::is_sharp(this->profile(c), vehicle.wheels[i].radius);
      if (!c.may_touch_several_points && (mesh_ == nullptr || mesh_->steps().empty())) continue;
      c.wheel = static_cast<int>(i);
      c.track = track[k];
      c.body = vehicle.wheels[i].body;
      c.law = vehicle.wheels[i].law;
      c.is_further = true;
      reset_contact(c);
      WheelContact& first = wheels[static_cast<std::size_t>(vehicle.first_wheel) + i];
      first.further = static_cast<int>(wheels.size());
      first.may_touch_several_points = c.may_touch_several_points;
      wheels.insert(wheels.end(), track::most_points - 1, c);
      c.factor = -1.0;
      wheels.insert(wheels.end(), further_entries - (track::most_points - 1), c);
    }
    add_pairs(static_cast<int>(k));
  }
  for (std::size_t k = 0; k < vehicles.size(); ++k) {
    MovingVehicle& vehicle = vehicles[k];
    for (int i = 0; i < contacts(); ++i)
      if (contact(i).vehicle == static_cast<int>(k)) vehicle.touching.push_back(i);
    // Neighbours are coupled most: in this order the equations of the contacts have a narrow band.
    std::stable_sort(vehicle.touching.begin(), vehicle.touching.end(), [&](int a, int b) {
      return vehicle.mechanism.model().bodies[static_cast<std::size_t>(contact(a).body)].position.x() >
             vehicle.mechanism.model().bodies[static_cast<std::size_t>(contact(b).body)].position.x();
    });
  }
  has_kinks_ = !kinks_of_motions().empty();
  set_own(0, static_cast<int>(vehicles.size()));
  start_rolling();
}

// The penetration under an equal share of the vehicle's weight.
double Fleet::static_penetration(const WheelContact& c) const {
  const MovingVehicle& vehicle = vehicles[c.vehicle];
  return contact::static_penetration(c.law, vehicle.weight / static_cast<double>(vehicle.wheels.size()));
}

void Fleet::set_static_penetrations() {
  for (WheelContact& c : wheels)
    if (c.candidates > 0) c.kinematics.penetration = static_penetration(c);
}

void Fleet::set_own(int first, int past) {
  first_own_ = first;
  past_own_ = past;
  is_set_ = false;
}

std::pair<int, int> Fleet::own_coordinates() const {
  const auto offset = [this](int k) { return k < static_cast<int>(vehicles.size()) ? vehicles[k].offset : freedom_; };
  return {offset(first_own_), offset(past_own_)};
}

void Fleet::add_pairs(int k) {
  MovingVehicle& vehicle = vehicles[k];
  vehicle.first_pair = static_cast<int>(pairs.size());
  const std::vector<multibody::Frame>& frames = vehicle.state.frames;  // the ground's first
  for (const contact::BodyContact& contact : vehicle.contacts) {
    PairContact c;
    c.vehicle = k;
    c.body = contact.bodies[0];
    c.other_body = contact.bodies[1];
    c.law = contact.law;
    c.geometry = contact::pair_geometry(contact, frames[c.body + 1], frames[c.other_body + 1]);
    pairs.push_back(c);
  }
}

int Fleet::member(int i) const {
  const Contact& c = contact(i);
  const auto begins_after = [](const std::pair<int, int>& place, const Member& member) {
    return place < std::pair(member.unit, member.first_body);
  };
  const auto next = std::upper_bound(members.begin(), members.end(), std::pair(c.vehicle, c.body), begins_after);
  return static_cast<int>(next - members.begin()) - 1;
}

const std::string& Fleet::name(int i) const {
  const std::size_t k = static_cast<std::size_t>(i);
  if (k < wheels.size()) return wheel(wheels[k]).name;
  const PairContact& c = pairs[k - wheels.size()];
  const MovingVehicle& vehicle = vehicles[c.vehicle];
  return vehicle.contacts[k - wheels.size() - static_cast<std::size_t>(vehicle.first_pair)].name;
}

Eigen::Vector3d Fleet::coordinates(const Contact& c) const {
  return vehicles[c.vehicle].state.q.segment<3>(3 * c.body);
}

Eigen::Vector3d Fleet::velocities(const Contact& c) const {
  return vehicles[c.vehicle].state.qd.segment<3>(3 * c.body);
}

bool Fleet::rotation_constrained(const WheelContact& c) const {
  const Eigen::MatrixXd& Phi_q = vehicles[c.vehicle].state.Phi_q;
  return Phi_q.rows() > 0 && Phi_q.col(3 * c.body + 2).lpNorm<Eigen::Infinity>() > free_to_turn;
}

void Fleet::start_rolling() {
  for (WheelContact& c : wheels) {
    c.turns = !frozen_ && !rotation_constrained(c) && (wheel(c).law.friction > 0.0 || velocities(c).z() != 0.0);
    c.roll_origin = c.turns ? coordinates(c).z() : coordinates(c).x();
  }
}

double Fleet::rolled_angle(const WheelContact& c) const {
  return c.turns ? c.roll_origin - coordinates(c).z() : (coordinates(c).x() - c.roll_origin) / wheel(c).radius;
}

// Adds the contribution of a wheel out of round: alpha = R + dr(a) - distance, where a follows from the body's angle or
// x.
void Fleet::add_shape(WheelContact& c) const {
  const Wheel& w = wheel(c);
  if (w.shape.round()) return;
  const track::RadiusGain gain = track::radius_gain(w.shape, w.radius, rolled_angle(c));
  const int along = c.turns ? 2 : 0;
  const double slope = c.turns ? -gain.slope : gain.slope / w.radius;
  c.touch.kinematics.penetration += gain.value;
  c.touch.kinematics.penetration_rate += slope * velocities(c)[along];
  c.touch.normal_on_body[along] += slope;
}

std::vector<std::string> Fleet::partition(double t) {
  std::vector<std::string> messages;
  for (MovingVehicle& vehicle : vehicles)
    for (const std::string& joint : vehicle.mechanism.choose_partition(vehicle.state, t))
      messages.push_back(vehicle.mechanism.model().name + ": " + joint + " has redundant equations, dropped");
  assign_coordinates(t);
  return messages;
}

bool Fleet::badly_conditioned() {
  const auto vehicles_here = own();
  return std::any_of(vehicles_here.begin(), vehicles_here.end(), [](MovingVehicle& v) {
    return v.dynamics->linear() == nullptr && v.mechanism.badly_conditioned(v.state);
  });
}

bool Fleet::accept() {
  bool renewed = false;
  for (MovingVehicle& vehicle : own()) {
    if (vehicle.dynamics->linear() != nullptr) continue;
    renewed = vehicle.mechanism.renew_partition(vehicle.state) || renewed;
    vehicle.mechanism.accept(vehicle.state);
  }
  return renewed;
}

void Fleet::assign_coordinates(double t) {
  origin_.clear();
  steady_rate_.clear();
  freedom_ = 0;
  for (std::size_t k = 0; k < vehicles.size(); ++k) {
    MovingVehicle& vehicle = vehicles[k];
    vehicle.offset = freedom_;
    freedom_ += vehicle.mechanism.freedom();
    const LinearDynamics* linear = vehicle.dynamics->linear();
    const double travelled = vehicle.travel.value(t);
    for (int i : vehicle.mechanism.partition().independent) {
      const bool rolls = i % 3 == 2 && !frozen_;
      const auto own = static_cast<Eigen::Index>(steady_rate_.size()) - vehicle.offset;
      steady_rate_.push_back(linear != nullptr        ? linear->matrices().c[own]
                             : vehicle.wheels.empty() ? 0.0
                             : i % 3 == 0             ? speeds_[k]
                             : rolls                  ? vehicle.state.qd[i]
                                                      : 0.0);
      origin_.push_back(vehicle.state.q[i] - steady_rate_.back() * travelled);
    }
  }
  position_.resize(origin_.size());
  velocity_.resize(origin_.size());
  is_set_ = false;
}

bool Fleet::set(double t, const double* p, const double* pd) {
  bool unchanged = is_set_ && t == time_;
  for (const MovingVehicle& vehicle : own()) {
    const double travelled = vehicle.travel.value(t), rate = vehicle.travel.rate(t);
    for (int i = vehicle.offset, past = i + vehicle.freedom(); i < past; ++i) {
      const double position = origin_[i] + steady_rate_[i] * travelled + p[i];
      const double velocity = steady_rate_[i] * rate + pd[i];
      unchanged = unchanged && position == position_[i] && velocity == velocity_[i];
      position_[i] = position;
      velocity_[i] = velocity;
    }
  }
  if (unchanged) return true;
  time_ = t;
  is_set_ = false;
  bool all = true;
  for (MovingVehicle& vehicle : own()) {
    all = all && !vehicle.converged;
    if (vehicle.converged) continue;
    if (!vehicle.dynamics->set(vehicle, t, position_.data() + vehicle.offset, velocity_.data() + vehicle.offset)) {
      failed_ = static_cast<int>(&vehicle - vehicles.data());
      return false;
    }
  }
  failed_ = -1;
  is_set_ = all;
  return true;
}

void Fleet::apply(int member, int body, const Eigen::Vector3d& action) {
  const Member& of = members[static_cast<std::size_t>(member)];
  MovingVehicle& vehicle = vehicles[static_cast<std::size_t>(of.unit)];
  if (vehicle.dynamics->linear() != nullptr)
    throw InputError("a force on a body needs vehicles as mechanisms: model_vehicles full");
  vehicle.mechanism.apply(of.first_body + body, action);
  is_set_ = false;
}

void Fleet::shift(const double* change, double rate) {
  for (MovingVehicle& vehicle : own()) vehicle.dynamics->shift(vehicle, change + vehicle.offset, rate);
  is_set_ = false;
}

void Fleet::coordinates_of_state(double t, double* p, double* pd) const {
  for (const MovingVehicle& vehicle : vehicles) {
    int at = vehicle.offset;
    const double travelled = vehicle.travel.value(t), rate = vehicle.travel.rate(t);
    for (int i : vehicle.mechanism.partition().independent) {
      p[at] = vehicle.state.q[i] - origin_[at] - steady_rate_[at] * travelled;
      pd[at] = vehicle.state.qd[i] - steady_rate_[at] * rate;
      ++at;
    }
  }
}

}  // namespace traverse::train
