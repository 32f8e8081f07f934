// The start of a run: static equilibrium or the given state, and what is known before the first step.
#include <algorithm>
#include <cmath>
#include <limits>

#include "traverse/beam/shape.hpp"
#include "traverse/coupling/system.hpp"

namespace traverse::coupling {
namespace {
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int static_positions = 2000;  // of the train along its way, for the static peak
}  // namespace

std::vector<std::string> System::start(bool equilibrium, double* y) {
  std::fill_n(y, local_size(), 0.0);
  if (equilibrium) {
    find_equilibrium(y);
  } else if (input_.self_weight && beam_ != nullptr) {
    std::copy(dead_load_.begin(), dead_load_.end(), nodal_.begin());
    if (const Solution found = settle(true, Part::beam); found != Solution::found) refuse_start(found);
    std::copy(nodal_.begin(), nodal_.end(), y);
  }
  for (MovingVehicle& vehicle : fleet_.vehicles)
    for (std::size_t b = 0; b < vehicle.mechanism.model().bodies.size(); ++b)
      vehicle.state.qd.segment<3>(3 * static_cast<Eigen::Index>(b)) = vehicle.mechanism.model().bodies[b].velocity;
  if (equilibrium) let_wheels_roll();
  std::vector<std::string> notes = fleet_.partition(0.0);  // makes the velocities fit the constraints
  fleet_.start_rolling();
  if (rank_ == 0) fleet_.coordinates_of_state(0.0, y + 2 * n_, y + 2 * n_ + fleet_.freedom());
  note_weights();
  return notes;
}

// A wheel with friction that can turn freely begins without sliding, unless its turning speed is given.
void System::let_wheels_roll() {
  for (const WheelContact& c : fleet_.wheels) {
    if (c.is_further) continue;
    MovingVehicle& vehicle = fleet_.vehicles[c.vehicle];
    const int turn = 3 * c.body + 2;
    if (fleet_.held(c) || fleet_.wheel(c).law.friction == 0.0 || vehicle.state.qd[turn] != 0.0) continue;
    vehicle.state.qd[turn] = -fleet_.velocities(c).x() / (fleet_.wheel(c).radius - c.kinematics.penetration);
  }
}

void System::note_weights() {
  weights_.clear();
  fleet_.contact_forces();
  for (const WheelContact& c : fleet_.wheels) weights_.emplace_back(fleet_.coordinates(c).x(), c.force.normal);
  for (std::size_t i = 0; i < input_.load.forces.size(); ++i)
    weights_.emplace_back(input_.load.positions[i], input_.load.forces[i]);
}

// When the ends of a wheel's flat meet the rail, where it rolls as its x is prescribed.
void System::add_flats(const WheelContact& c, double end, std::vector<double>& events) const {
  const Wheel& wheel = fleet_.wheel(c);
  if (c.turns || input_.train.speed <= 0.0) return;
  const double turning = input_.train.speed / wheel.radius;
  for (double angle : track::flat_ends(wheel.shape, wheel.radius, turning * end)) events.push_back(angle / turning);
}

std::vector<double> System::corners() const {
  std::vector<double> corners = input_.profile.kinks();
  if (beam_ != nullptr) corners.insert(corners.end(), line_->mesh.kinks().begin(), line_->mesh.kinks().end());
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::vector<double> System::known_events(double end, bool all_kinks) const {
  std::vector<double> kinks;
  if (all_kinks) kinks = corners();
  if (beam_ != nullptr && !all_kinks) kinks = {line_->mesh.start(), line_->mesh.end()};
  std::vector<double> events;
  auto add = [&](double x, double speed) {
    if (speed <= 0.0) return;
    for (double kink : kinks) {
      const double t = (kink - x) / speed;
      if (t > 0.0 && t < end) events.push_back(t);
    }
  };
  if (input_.train.drive == Drive::constant && all_kinks)
    for (const WheelContact& c : fleet_.wheels) {
      if (c.is_further) continue;
      add(fleet_.coordinates(c).x(), input_.train.speed);
      add_flats(c, end, events);
    }
  for (double x : input_.load.positions) add(x, input_.load.speed);
  for (const MovingVehicle& vehicle : fleet_.vehicles)
    for (const multibody::Actuator& actuator : vehicle.mechanism.model().actuators)
      for (const base::TimeFunction& f : actuator.action)
        for (double t : f.kinks())
          if (t > 0.0 && t < end) events.push_back(t);
  std::sort(events.begin(), events.end());
  return events;
}

double System::leaving_time() const {
  if (beam_ == nullptr || (fleet_.wheels.empty() && input_.load.forces.empty())) return infinite;
  const double length = beam_->mesh().end();
  double last = 0.0;
  auto leave = [&](double x, double speed) {
    if (x < length) last = std::max(last, speed > 0.0 ? (length - x) / speed : infinite);
  };
  for (const WheelContact& c : fleet_.wheels) leave(fleet_.coordinates(c).x(), input_.train.speed);
  for (double x : input_.load.positions) leave(x, input_.load.speed);
  return last;
}

// Deflection and rotation at every node of the line that wheels run on under a unit downward force on the bridge at
// `station`, complete on every rank: what that force's place deflects by when the unit force travels.
std::vector<double> System::influence_line(double station) {
  std::fill(nodal_.begin(), nodal_.end(), 0.0);
  const beam::Station s = beam_->mesh().locate(station);
  add_point_load(beam_->bridge(), {s.element, s.xi, 0.0, -1.0, 0.0}, nodal_.data());
  release_held(nodal_.data());
  operator_->solve_static(nodal_.data());
  influence_of_weight_ = 0.0;
  for (int i = 0; i < n_; ++i) influence_of_weight_ -= nodal_[i] * dead_load_[i];
  MPI_Allreduce(MPI_IN_PLACE, &influence_of_weight_, 1, MPI_DOUBLE, MPI_SUM, comm_);
  std::vector<double> line(4 * static_cast<std::size_t>(line_->mesh.elements()), 0.0);
  for (int e = 0; e < line_->mesh.elements(); ++e) {
    const auto unknowns = line_->transverse(e);
    for (int i = 0; i < 4; ++i) {
      const int local = beam_->local(unknowns[i]);
      if (local >= 0) line[4 * static_cast<std::size_t>(e) + i] = nodal_[local];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, line.data(), static_cast<int>(line.size()), MPI_DOUBLE, MPI_SUM, comm_);
  return line;
}

double System::ordinate(const std::vector<double>& line, double x) const {
  const beam::Mesh& mesh = line_->mesh;
  if (x < mesh.start() || x > mesh.end()) return 0.0;
  const beam::Station s = mesh.locate(x);
  const beam::Hermite psi = beam::hermite(s.xi, mesh.element(s.element).length);
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += psi.value[i] * line[4 * static_cast<std::size_t>(s.element) + i];
  return sum;
}

// Whether one influence line serves for all weights at once.
bool System::passes_together() const {
  if (beam_ == nullptr || weights_.empty() || nonlinear_) return false;  // without superposition there is none
  const bool apart = input_.train.speed != input_.load.speed;            // train and forces pass each other
  return !apart || fleet_.wheels.empty() || input_.load.forces.empty();
}

double System::static_peak(double station) {
  if (!passes_together()) return 0.0;
  const std::vector<double> line = influence_line(station);
  return peak_of_weights(line, station, influence_of_weight_);
}

// What a single load does that deflects the station at most as the passing weights do, J; 0: there is none.
double System::static_energy(double station) {
  if (!passes_together()) return 0.0;
  const std::vector<double> line = influence_line(station);
  const double deflection = peak_of_weights(line, station, 0.0), compliance = std::abs(ordinate(line, station));
  return compliance > 0.0 ? 0.5 * deflection * deflection / compliance : 0.0;
}

// Of the station, the constant added.
double System::peak_of_weights(const std::vector<double>& line, double station, double constant) const {
  const beam::Mesh& mesh = line_->mesh;
  double front = -infinite, rear = infinite;
  for (const auto& [x, force] : weights_) {
    front = std::max(front, x);
    rear = std::min(rear, x);
  }
  // Every weight over the station in turn (where the line peaks), and evenly along the whole way.
  double peak = 0.0;
  auto try_shift = [&](double shift) {
    double sum = constant;
    for (const auto& [x, force] : weights_) sum += force * ordinate(line, x + shift);
    peak = std::max(peak, std::abs(sum));
  };
  for (const auto& [x, force] : weights_) try_shift(station - x);
  for (int i = 0; i <= static_positions; ++i) try_shift(-front + (mesh.end() + front - rear) * i / static_positions);
  return peak;
}

}  // namespace traverse::coupling
