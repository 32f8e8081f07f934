// States of a fleet's vehicles between steps: start, energies, powers, archive, and reasons of failures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "linear_dynamics.hpp"
#include "train/fleet.hpp"

namespace traverse::train {
namespace {

constexpr double most_displacement = 100.0;  // m: bodies with larger displacements are not supported

}  // namespace

double MovingVehicle::step_error(const double* error_of_pdd, const double* pdd) {
  const Eigen::VectorXd& mass = mechanism.mass_diagonal();
  const auto sum = [&](const double* of_p) {  // masses times squares of the accelerations B of_p
    state.work.setZero();
    state.dependent_block.expand(of_p, state.work);
    return mass.dot(state.work.cwiseAbs2());
  };
  const double error = sum(error_of_pdd), motion = sum(pdd);
  double total = 0.0;  // kg
  for (Eigen::Index i = 0; i < mass.size(); i += 3) total += mass[i];
  return std::sqrt(error * total) / (scale + std::sqrt(motion * total));
}

void Fleet::copy_positions(const Fleet& other) {
  for (std::size_t k = 0; k < vehicles.size(); ++k) vehicles[k].state.q = other.vehicles[k].state.q;
  for (int i = 0; i < contacts(); ++i) {
    contact(i).kinematics = other.contact(i).kinematics;
    contact(i).law.local_compliance = other.contact(i).law.local_compliance;
  }
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    wheels[i].minimum_station = other.wheels[i].minimum_station;
    wheels[i].share = other.wheels[i].share;
  }
}

void Fleet::start_moving() {
  for (MovingVehicle& vehicle : vehicles)
    for (std::size_t b = 0; b < vehicle.mechanism.model().bodies.size(); ++b)
      vehicle.state.qd.segment<3>(3 * static_cast<Eigen::Index>(b)) = vehicle.mechanism.model().bodies[b].velocity;
}

void Fleet::set_rolling_speeds() {
  for (const WheelContact& c : wheels) {
    if (c.is_further) continue;
    double& turning = vehicles[c.vehicle].state.qd[3 * static_cast<Eigen::Index>(c.body) + 2];
    if (rotation_constrained(c) || wheel(c).law.friction == 0.0 || turning != 0.0) continue;
    turning = -velocities(c).x() / (wheel(c).radius - c.kinematics.penetration);
  }
}

std::string Fleet::unsupported_body(const Fleet& start) const {
  std::string text;
  double largest = most_displacement;
  for (std::size_t k = 0; k < vehicles.size(); ++k) {
    const MovingVehicle& vehicle = vehicles[k];
    const multibody::MechanismModel& model = vehicle.mechanism.model();
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const auto at = 3 * static_cast<Eigen::Index>(b);
      const double displacement = (vehicle.state.q - start.vehicles[k].state.q).segment<2>(at).norm();
      if (displacement <= largest) continue;
      largest = displacement;
      text = fmt::format("nothing holds body '{}' of vehicle '{}'", model.bodies[b].name, model.name);
      for (std::size_t s = 0; s < model.springs.size(); ++s) {
        const multibody::Spring& spring = model.springs[s];
        const bool attached = spring.bodies[0] == static_cast<int>(b) || spring.bodies[1] == static_cast<int>(b);
        if (attached && vehicle.mechanism.spring_tension(vehicle.state, static_cast<int>(s)) == 0.0)
          text += fmt::format(", its spring '{}' stays loose", spring.name);
      }
      for (std::size_t r = 0; r < model.ropes.size(); ++r) {
        const std::vector<int>& bodies = model.ropes[r].bodies;
        const bool attached = std::find(bodies.begin(), bodies.end(), static_cast<int>(b)) != bodies.end();
        if (attached && vehicle.mechanism.rope_tension(vehicle.state, static_cast<int>(r)) == 0.0)
          text += fmt::format(", its rope '{}' stays slack", model.ropes[r].name);
      }
    }
  }
  return text;
}

std::vector<double> Fleet::kinks_of_motions() const {
  std::vector<double> kinks;
  const auto add = [&](const base::TimeFunction& f) { kinks.insert(kinks.end(), f.kinks().begin(), f.kinks().end()); };
  for (const MovingVehicle& vehicle : vehicles) {
    for (const multibody::Driver& driver : vehicle.mechanism.model().drivers) add(driver.value);
    for (const multibody::Spring& spring : vehicle.mechanism.model().springs)
      if (spring.winding) add(*spring.winding);
    for (const multibody::Rope& rope : vehicle.mechanism.model().ropes)
      if (rope.winding) add(*rope.winding);
  }
  return kinks;
}

std::vector<double> Fleet::kinks_of_actions() const {
  std::vector<double> kinks = kinks_of_motions();
  for (const MovingVehicle& vehicle : vehicles)
    for (const multibody::Actuator& actuator : vehicle.mechanism.model().actuators)
      for (const base::TimeFunction& f : actuator.action)
        for (double t : f.kinks()) kinks.push_back(t);
  return kinks;
}

bool Fleet::begin_step(double middle) {
  if (!has_kinks_) return false;
  bool jumped = false;
  for (MovingVehicle& vehicle : vehicles) {
    jumped = vehicle.mechanism.select_sides(middle) || jumped;
    vehicle.travel.select_side(middle);
  }
  if (jumped) is_set_ = false;
  return jumped;
}

// From now on s of the vehicle is the distance that its drives prescribe, with steady rates per metre, so that p and
// p'' remain small at any speed. The state is that at t = 0, where the distance is 0.
void Fleet::measure_by_distance(MovingVehicle& vehicle) {
  vehicle.travel = vehicle.speed.from(0.0);
  vehicle.travel.select_side(0.0);
  const std::vector<int>& independent = vehicle.mechanism.partition().independent;
  double* rate = steady_rate_.data() + vehicle.offset;
  for (std::size_t i = 0; i < independent.size(); ++i) rate[i] = independent[i] % 3 == 0 ? 1.0 : 0.0;
  for (const WheelContact& c : wheels) {
    if (c.is_further || &vehicles[c.vehicle] != &vehicle || wheel(c).law.friction == 0.0) continue;
    const auto turning = std::find(independent.begin(), independent.end(), 3 * c.body + 2);
    if (turning == independent.end() || rotation_constrained(c)) continue;
    rate[turning - independent.begin()] = -1.0 / (wheel(c).radius - c.kinematics.penetration);
  }
}

std::vector<std::string> Fleet::linearise() {
  std::vector<std::string> messages;
  std::size_t linearised = 0;
  for (MovingVehicle& vehicle : own()) {
    const std::string obstacle = LinearDynamics::obstacle(vehicle);
    if (obstacle.empty()) {
      ++linearised;
      if (!vehicle.speed.constant()) measure_by_distance(vehicle);
      vehicle.dynamics = AnyDynamics(std::make_unique<LinearDynamics>(vehicle, steady_rate_.data() + vehicle.offset));
    } else if (std::string message = fmt::format("vehicle '{}' is not linearised: {}", vehicle.name(), obstacle);
               std::find(messages.begin(), messages.end(), message) == messages.end()) {
      messages.push_back(std::move(message));
    }
  }
  if (linearised > 0)
    messages.insert(messages.begin(), fmt::format("{} linearised about their initial state",
                                                  linearised == own().size() ? "vehicles are" : "some vehicles are"));
  return messages;
}

void Fleet::observe(const double* pdd) {
  for (MovingVehicle& vehicle : own())
    if (vehicle.dynamics->observe(vehicle, pdd + vehicle.offset)) is_set_ = false;
}

double Fleet::linearisation_residual() const {
  double largest = 0.0;
  for (const MovingVehicle& vehicle : own())
    if (const LinearDynamics* linear = vehicle.dynamics->linear())
      largest = std::max(largest, linear->linearisation_residual());
  return largest;
}

base::Powers Fleet::powers() const {
  base::Powers sum;
  for (const MovingVehicle& vehicle : own()) sum += vehicle.dynamics->powers(vehicle);
  return sum;
}

multibody::MechanismEnergy Fleet::energy() const {
  multibody::MechanismEnergy sum;
  for (const MovingVehicle& vehicle : vehicles) {
    const multibody::MechanismEnergy more = vehicle.dynamics->energy(vehicle);
    sum.kinetic += more.kinetic;
    sum.strain += more.strain;
    sum.potential += more.potential;
  }
  return sum;
}

std::string Fleet::failure_reason() const {
  for (const MovingVehicle& vehicle : own())
    if (vehicle.state.friction.jammed) return vehicle.mechanism.describe_jam(vehicle.state);
  if (failed_ < 0) return {};
  const MovingVehicle& failed = vehicles[static_cast<std::size_t>(failed_)];
  return "vehicle '" + failed.name() + "' is locked: " + failed.mechanism.worst_row(failed.state) +
         ", wherever else its bodies go; a driver pulls it beyond its reach or through a dead point";
}

void Fleet::keep(base::Archive& archive, const std::vector<int>& owners) {
  for (std::size_t k = 0; k < vehicles.size(); ++k) {
    archive.of(owners[k], vehicles[k]);
    for (WheelContact& wheel : wheels)
      if (wheel.vehicle == static_cast<int>(k)) archive.of(owners[k], wheel);
    for (PairContact& pair : pairs)
      if (pair.vehicle == static_cast<int>(k)) archive.of(owners[k], pair);
  }
  archive.same(elements_, unmodelled_contact_, origin_, steady_rate_, failed_);
  archive.cache(position_, velocity_, time_, is_set_);
  is_set_ = is_set_ && archive.same_ranks();
}

}  // namespace traverse::train
