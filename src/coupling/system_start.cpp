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
  const bool weighed = !equilibrium && weigh_at_rest();
  if (equilibrium) {
    find_equilibrium(y);
  } else if (structure_ && structure_->bent_at_rest()) {
    structure_->load({});
    if (const Solution found = settle(Terms::beam); found != Solution::found) refuse_start(found);
    structure_->end_stage(y, y + n_);
  }
  fleet_.start_moving();
  if (equilibrium) {
    fleet_.let_wheels_roll();
    if (!stays) go_with_the_train(y + n_);
  }
  std::vector<std::string> notes = fleet_.partition(0.0);  // makes the velocities fit the constraints
  fleet_.start_rolling();
  if (rank_ == 0) fleet_.coordinates_of_state(0.0, y + 2 * n_, y + 2 * n_ + fleet_.freedom());
  if (!weighed) note_weights();
  return notes;
}

// What the wheels weigh, whatever state the scene gives them to start with. False where they find no rest.
bool System::weigh_at_rest() {
  if (!structure_ || fleet_.wheels.empty()) return false;
  train::Fleet given = fleet_;
  std::vector<double> at_rest(2 * static_cast<std::size_t>(n_));
  bool found = true;
  try {
    find_equilibrium(at_rest.data());
    note_weights();
  } catch (const SolverError&) {
    found = false;
    nothing_holds_.clear();
  }
  fleet_ = std::move(given);
  return found;
}

void System::note_weights() {
  std::vector<PassingWeight> weights;
  fleet_.contact_forces();
  for (const train::WheelContact& c : fleet_.wheels)
    weights.push_back({fleet_.coordinates(c).x(), c.force.normal, input_.train.speed});
  for (std::size_t i = 0; i < input_.load.forces.size(); ++i)
    weights.push_back({input_.load.positions[i], input_.load.forces[i], input_.load.speed});
  weights_.set(std::move(weights), fleet_.wheels.size());
}

// When the ends of a wheel's flat meet the rail, where it rolls as its x is prescribed.
void System::add_flats(const train::WheelContact& c, double end, std::vector<double>& events) const {
  const train::Wheel& wheel = fleet_.wheel(c);
  if (c.turns || input_.train.speed <= 0.0) return;
  const double turning = input_.train.speed / wheel.radius;
  for (double angle : track::flat_ends(wheel.shape, wheel.radius, turning * end)) events.push_back(angle / turning);
}

std::vector<double> System::corners() const {
  std::vector<double> corners = input_.profile.kinks();
  if (line_ != nullptr) corners.insert(corners.end(), line_->mesh.kinks().begin(), line_->mesh.kinks().end());
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::vector<double> System::known_events(double end, bool all_kinks) const {
  std::vector<double> kinks;
  if (all_kinks) kinks = corners();
  if (line_ != nullptr && !all_kinks) kinks = {line_->mesh.start(), line_->mesh.end()};
  std::vector<double> events;
  auto add = [&](double x, double speed) {
    if (speed <= 0.0) return;
    for (double kink : kinks) {
      const double t = (kink - x) / speed;
      if (t > 0.0 && t < end) events.push_back(t);
    }
  };
  if (input_.train.drive == train::Drive::constant && all_kinks)
    for (const train::WheelContact& c : fleet_.wheels) {
      if (c.is_further) continue;
      add(fleet_.coordinates(c).x(), input_.train.speed);
      add_flats(c, end, events);
    }
  for (double x : input_.load.positions) add(x, input_.load.speed);
  for (double t : fleet_.kinks_of_actions())
    if (t > 0.0 && t < end) events.push_back(t);
  std::sort(events.begin(), events.end());
  return events;
}

double System::leaving_time() const {
  if (!structure_ || (fleet_.wheels.empty() && input_.load.forces.empty())) return infinite;
  const double length = beam()->mesh().end();
  double last = 0.0;
  auto leave = [&](double x, double speed) {
    if (x < length) last = std::max(last, speed > 0.0 ? (length - x) / speed : infinite);
  };
  for (const train::WheelContact& c : fleet_.wheels) leave(fleet_.coordinates(c).x(), input_.train.speed);
  for (double x : input_.load.positions) leave(x, input_.load.speed);
  return last;
}

}  // namespace traverse::coupling
