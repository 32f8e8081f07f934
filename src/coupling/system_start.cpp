// The start of a run: static equilibrium or the given state, and what is known before the first step.
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
  const bool weighed = !equilibrium && static_wheel_loads();
  if (equilibrium) {
    find_equilibrium(y);
  } else if (structure_ && structure_->bent_at_rest()) {
    structure_->load({});
    if (const Solution found = solve_statics(Terms::beam); found != Solution::found) refuse_start(found);
    structure_->end_stage(y, y + n_);
  }
  if (structure_) structure_->update_slip(y, loaded(0.0, 0.0));
  fleet_.start_moving();
  if (equilibrium) {
    fleet_.let_wheels_roll();
    if (!stays) go_with_the_train(y + n_);
  }
  std::vector<std::string> notes = fleet_.partition(0.0);  // makes the velocities fit the constraints
  if (equilibrium && !stays) follow_surface(y);
  fleet_.start_rolling();
  if (rank_ == 0) fleet_.coordinates_of_state(0.0, y + 2 * n_, y + 2 * n_ + fleet_.freedom());
  if (!weighed) record_weights();
  return notes;
}

// What the wheels weigh, whatever state the scene gives them to start with. False where they find no rest.
bool System::static_wheel_loads() {
  if (!structure_ || fleet_.wheels.empty()) return false;
  train::Fleet given = fleet_;
  std::vector<double> at_rest(2 * static_cast<std::size_t>(n_));
  bool found = true;
  try {
    find_equilibrium(at_rest.data());
    record_weights();
  } catch (const SolverError&) {
    found = false;
    nothing_holds_.clear();
  }
  fleet_ = std::move(given);
  return found;
}

void System::record_weights() {
  std::vector<StaticLoad> weights;
  fleet_.contact_forces();
  for (int i = 0; i < static_cast<int>(fleet_.wheels.size()); ++i) {
    const train::WheelContact& c = fleet_.wheels[static_cast<std::size_t>(i)];
    weights.push_back({fleet_.coordinates(c).x(), c.force.normal, law_of_wheel(i)});
  }
  for (std::size_t i = 0; i < input_.load.forces.size(); ++i)
    weights.push_back({input_.load.positions[i], input_.load.forces[i], train::law_of(input_.load, i)});
  weights_.set(std::move(weights), fleet_.wheels.size());
  record_braking();
}

base::SpeedLaw System::law_of_wheel(int wheel) const {
  return train::law_of(input_.train, static_cast<std::size_t>(fleet_.member(wheel)));
}

bool System::is_driven(int wheel) const {
  return train::drive_of(input_.train, static_cast<std::size_t>(fleet_.member(wheel))) == train::Drive::constant;
}

// When the ends of a wheel's flat meet the rail, where it rolls as its x is prescribed.
void System::add_flats(const train::WheelContact& c, const base::SpeedLaw& law, double end,
                       std::vector<double>& events) const {
  const train::Wheel& wheel = fleet_.wheel(c);
  const double way = law.distance(end);
  if (c.turns || way == 0.0) return;
  track::WheelShape shape = wheel.shape;
  if (way < 0.0) shape.flat_angle = -shape.flat_angle;
  for (double angle : track::flat_ends(shape, wheel.radius, std::abs(way) / wheel.radius))
    events.push_back(law.time_of(std::copysign(angle * wheel.radius, way)));
}

std::vector<double> System::corners(const track::Profile& profile) const {
  std::vector<double> corners = profile.kinks();
  if (line_ != nullptr) corners.insert(corners.end(), line_->mesh.kinks().begin(), line_->mesh.kinks().end());
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::vector<double> System::known_events(double end, bool all_kinks) const {
  std::vector<double> events;
  const auto note = [&](double t) {
    if (t > 0.0 && t < end) events.push_back(t);
  };
  const auto add = [&](double x, const base::SpeedLaw& law, const std::vector<double>& kinks) {
    if (law.standstill() == 0.0) return;
    for (double kink : kinks) note(law.time_of(kink - x));
  };
  for (int i = 0; i < static_cast<int>(fleet_.wheels.size()); ++i) {
    const train::WheelContact& c = fleet_.wheels[static_cast<std::size_t>(i)];
    if (c.is_further || !is_driven(i)) continue;
    const base::SpeedLaw law = law_of_wheel(i);
    if (brakes_track(i)) add(fleet_.coordinates(c).x(), law, {line_->mesh.start(), line_->mesh.end()});
    if (!all_kinks) continue;
    add(fleet_.coordinates(c).x(), law, corners(fleet_.profile(c)));
    add_flats(c, law, end, events);
  }
  std::vector<double> kinks;
  if (all_kinks)
    kinks = corners();
  else if (line_ != nullptr)
    kinks = {line_->mesh.start(), line_->mesh.end()};
  for (std::size_t i = 0; i < input_.load.positions.size(); ++i)
    add(input_.load.positions[i], train::law_of(input_.load, i), kinks);
  for (const train::Course& course : input_.load.courses)
    for (double t : course.speed.kinks()) note(t);
  for (double t : fleet_.kinks_of_actions()) note(t);
  std::sort(events.begin(), events.end());
  return events;
}

double System::leaving_time() const {
  if (!structure_ || (fleet_.wheels.empty() && input_.load.forces.empty())) return infinite;
  const double length = beam()->mesh().end();
  double last = 0.0;
  bool moves = false, stands = false;
  const auto leave = [&](double x, const base::SpeedLaw& law) {
    const bool to_the_left = law.direction() < 0.0;
    const double predicted = law.standstill();
    moves = moves || predicted > 0.0;
    if (to_the_left ? x <= 0.0 : x >= length) return;
    stands = stands || predicted == 0.0;
    last = std::max(last, std::min(law.time_of(to_the_left ? -x : length - x), predicted));
  };
  for (int i = 0; i < static_cast<int>(fleet_.wheels.size()); ++i)
    leave(fleet_.coordinates(fleet_.wheels[static_cast<std::size_t>(i)]).x(), law_of_wheel(i));
  for (std::size_t i = 0; i < input_.load.positions.size(); ++i)
    leave(input_.load.positions[i], train::law_of(input_.load, i));
  return stands && !moves ? infinite : last;
}

}  // namespace traverse::coupling
