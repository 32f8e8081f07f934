// The start of a run: static equilibrium or the given state, and data known before the first step.
#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/system.hpp"

namespace traverse::coupling {
namespace {
constexpr double infinite = std::numeric_limits<double>::infinity();
}  // namespace

std::vector<std::string> System::start(bool equilibrium, double* y, bool stays) {
  std::fill_n(y, local_size(), 0.0);
  // On an incline, the static wheel loads determine the forces along the track that hold the vehicles; in a curve or on
  // cant, their torques.
  const bool shifts = structure_ && beam()->model().torsion && beam()->model().torsion->shifts();
  const bool loads_known = (!equilibrium || gradient() != 0.0 || shifts) && static_wheel_loads();
  if (loads_known) begin_step(0.0, 0.0);
  if (equilibrium) {
    find_equilibrium(y);
  } else if (structure_ && structure_->deformed_without_traffic()) {
    structure_->load({});
    if (const Solution found = solve_statics(0.0, false); found != Solution::found) throw_no_equilibrium(found);
    structure_->end_stage(y, y + n_);
  }
  if (structure_) structure_->accept(y, y + n_, loaded(0.0, 0.0));
  fleet_.start_moving();
  if (equilibrium) {
    fleet_.set_rolling_speeds();
    if (!stays) set_rail_velocity(y + n_);
  }
  std::vector<std::string> messages = fleet_.partition(0.0);  // makes the velocities consistent with the constraints
  if (equilibrium && !stays) follow_surface(y);
  fleet_.start_rolling();
  if (rank_ == 0) fleet_.coordinates_of_state(0.0, y + 2 * n_, y + 2 * n_ + fleet_.freedom());
  if (!loads_known) record_weights();
  return messages;
}

// Computes the static wheel loads for a given initial state. False if there is no equilibrium.
bool System::static_wheel_loads() {
  if (!structure_ || fleet_.wheels.empty()) return false;
  train::Fleet initial = fleet_;
  std::vector<double> at_rest(2 * static_cast<std::size_t>(n_));
  bool found = true;
  try {
    find_equilibrium(at_rest.data());
    record_weights();
  } catch (const SolverError&) {
    found = false;
    unsupported_.clear();
  }
  fleet_ = std::move(initial);
  return found;
}

void System::record_weights() {
  std::vector<StaticLoad> weights;
  fleet_.contact_forces();
  for (int i = 0; i < static_cast<int>(fleet_.wheels.size()); ++i) {
    const train::WheelContact& c = fleet_.wheels[static_cast<std::size_t>(i)];
    weights.push_back({fleet_.coordinates(c).x(), c.force.normal, law_of_wheel(i), 0.0, c.track});
  }
  for (std::size_t i = 0; i < input_.load.forces.size(); ++i)
    weights.push_back({input_.load.positions[i], input_.load.forces[i], train::law_of(input_.load, i),
                       train::length_of(input_.load, i), track_of(input_.load, i)});
  weights_.set(std::move(weights), fleet_.wheels.size());
  record_braking();
  record_shifted();
}

base::SpeedLaw System::law_of_wheel(int wheel) const {
  return train::law_of(input_.train, static_cast<std::size_t>(fleet_.member(wheel)));
}

bool System::is_driven(int wheel) const {
  return train::drive_of(input_.train, static_cast<std::size_t>(fleet_.member(wheel))) == train::Drive::constant;
}

// Adds the times at which the ends of a wheel's flat touch the rail, for a rolling wheel with prescribed x.
void System::add_flats(const train::WheelContact& c, const base::SpeedLaw& law, double end,
                       std::vector<double>& events) const {
  const train::Wheel& wheel = fleet_.wheel(c);
  const double travel = law.distance(end);
  if (c.turns || travel == 0.0) return;
  track::WheelShape shape = wheel.shape;
  if (travel < 0.0) shape.flat_angle = -shape.flat_angle;
  for (double angle : track::flat_ends(shape, wheel.radius, std::abs(travel) / wheel.radius))
    events.push_back(law.time_of(std::copysign(angle * wheel.radius, travel)));
}

std::vector<double> System::surface_kinks(const track::Profile& profile) const {
  std::vector<double> kinks = profile.kinks();
  if (line_ != nullptr) kinks.insert(kinks.end(), line_->mesh.kinks().begin(), line_->mesh.kinks().end());
  std::sort(kinks.begin(), kinks.end());
  return kinks;
}

std::vector<double> System::known_events(double end, bool all_kinks) const {
  std::vector<double> events;
  const auto record = [&](double t) {
    if (t > 0.0 && t < end) events.push_back(t);
  };
  const auto add = [&](double x, const base::SpeedLaw& law, const std::vector<double>& kinks) {
    if (law.standstill() == 0.0) return;
    for (double kink : kinks) record(law.time_of(kink - x));
  };
  for (int i = 0; i < static_cast<int>(fleet_.wheels.size()); ++i) {
    const train::WheelContact& c = fleet_.wheels[static_cast<std::size_t>(i)];
    if (c.is_further || !is_driven(i)) continue;
    const base::SpeedLaw law = law_of_wheel(i);
    if (brakes_track(i)) add(fleet_.coordinates(c).x(), law, {line_->mesh.start(), line_->mesh.end()});
    if (!all_kinks) continue;
    add(fleet_.coordinates(c).x(), law, surface_kinks(fleet_.profile(c)));
    add_flats(c, law, end, events);
  }
  std::vector<double> kinks, nodes;
  if (line_ != nullptr) kinks = nodes = {line_->mesh.start(), line_->mesh.end()};
  if (all_kinks && line_ != nullptr) {
    kinks = surface_kinks();
    for (int e = 0; e < line_->mesh.elements(); ++e) nodes.push_back(line_->mesh.element(e).x);
  }
  for (std::size_t i = 0; i < input_.load.positions.size(); ++i) {
    // The ends of a line load; a moment acts on rotations, whose shapes have kinks at the nodes.
    const double reach = 0.5 * train::length_of(input_.load, i);
    const std::vector<double>& at = train::moment_of(input_.load, i) == 0.0 ? kinks : nodes;
    for (const double side : reach > 0.0 ? std::vector<double>{-reach, reach} : std::vector<double>{0.0})
      add(input_.load.positions[i] + side, train::law_of(input_.load, i), at);
  }
  for (const train::Course& course : input_.load.courses) {
    for (double t : course.speed.kinks()) record(t);
    for (double t : course.variation.kinks()) record(t);
  }
  for (double t : fleet_.kinks_of_actions()) record(t);
  if (structure_ && structure_->support_motion() != nullptr)
    for (double t : structure_->support_motion()->rows()) record(t);
  std::sort(events.begin(), events.end());
  return events;
}

double System::leaving_time() const {
  if (!structure_ || (fleet_.wheels.empty() && input_.load.forces.empty())) return infinite;
  const double length = beam()->mesh().end();
  double last = 0.0;
  bool any_moves = false, any_stationary = false;
  const auto add_leaving_time = [&](double x, const base::SpeedLaw& law, double half_length) {
    const bool leftwards = law.direction() < 0.0;
    x += leftwards ? half_length : -half_length;
    const double standstill = law.standstill();
    any_moves = any_moves || standstill > 0.0;
    if (leftwards ? x <= 0.0 : x >= length) return;
    any_stationary = any_stationary || standstill == 0.0;
    last = std::max(last, std::min(law.time_of(leftwards ? -x : length - x), standstill));
  };
  for (int i = 0; i < static_cast<int>(fleet_.wheels.size()); ++i)
    add_leaving_time(fleet_.coordinates(fleet_.wheels[static_cast<std::size_t>(i)]).x(), law_of_wheel(i), 0.0);
  for (std::size_t i = 0; i < input_.load.positions.size(); ++i)
    add_leaving_time(input_.load.positions[i], train::law_of(input_.load, i), 0.5 * train::length_of(input_.load, i));
  return any_stationary && !any_moves ? infinite : last;
}

}  // namespace traverse::coupling
