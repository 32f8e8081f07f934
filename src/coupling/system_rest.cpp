// The static equilibrium at the start of a run.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "coupling/system.hpp"

namespace traverse::coupling {
namespace {

// Continuation to the static equilibrium if Newton's method does not converge directly: springs tie all masses to their
// positions. Their frequency squared, 1/s2, decreases from step to step, and their ends move to the new positions.
// Unsupported bodies move down until they touch a support.
constexpr double first_tie = 1e3, last_tie = 1e-2;
constexpr double softer = 0.5, stiffer = 8.0;  // factors after a step with a solution, and after one without
constexpr int most_ties = 200;
constexpr double balanced_acceleration = 0.02;  // remaining forces of the ties, as acceleration relative to gravity
constexpr double rail_offset = 1e-3;            // m: half the distance for the derivative of the rail's deflection
constexpr double rigid_tie = 1e10;              // 1/s2, tie of the vehicles' positions

}  // namespace

// Solves the stage problem at shift 0 with all drives at rest: the static equilibrium of structure and vehicles.
void System::find_equilibrium(double* y) {
  train::Fleet moving = std::move(fleet_);
  freeze_fleet(input_.train);
  if (structure_) load_structure(0.0);
  Solution found = solve_statics();
  if (found == Solution::fleet_failed) {
    freeze_fleet(input_.train);
    found = solve_statics_slowly();
  }
  if (found != Solution::found) throw_no_equilibrium(found);
  if (structure_) structure_->end_stage(y, y + n_);
  fleet_.set(0.0, p_.data(), pd_predicted_.data());
  moving.copy_positions(fleet_);
  fleet_ = std::move(moving);
}

// Initial velocities of a rail under moving wheels. The rail's deflection moves with the wheels: rail, sleepers and
// ballast have its velocity, computed from the static deflections with the wheels slightly before and behind at the
// same height. A rail initially at rest would lift the wheels, by 7 % of their weight at 300 km/h. The bridge cannot
// follow in so short a time: it starts at rest.
void System::set_rail_velocity(double* w) {
  const double speed = fleet_.wheels.empty() ? 0.0 : law_of_wheel(0).speed(0.0);
  if (!structure_ || beam()->rail() == nullptr || speed == 0.0) return;
  train::Fleet moving = std::move(fleet_);
  std::array<std::vector<double>, 2> v;
  bool found = true;
  for (const std::size_t after : {0, 1}) {
    const double offset = after == 1 ? rail_offset : -rail_offset;
    train::Train train = input_.train;
    for (double& x : train.positions) x += offset;
    freeze_fleet(train);
    fleet_.copy_positions(moving);
    for (train::MovingVehicle& vehicle : fleet_.vehicles)
      for (Eigen::Index i = 0; i < vehicle.state.q.size(); i += 3) vehicle.state.q[i] += offset;
    fleet_.coordinates_of_state(0.0, p_predicted_.data(), pd_predicted_.data());
    load_structure(offset / speed);
    found = found && solve_statics(rigid_tie) == Solution::found;
    v[after].resize(static_cast<std::size_t>(n_));
    structure_->end_stage(v[after].data(), w);
  }
  fleet_ = std::move(moving);
  load_structure(0.0);
  const double rate = found ? speed / (2.0 * rail_offset) : 0.0;
  for (int i = 0; i < n_; ++i) w[i] = rate * (v[1][i] - v[0][i]);
  const beam::Line& bridge = beam()->bridge();
  for (int node = 0; node < bridge.mesh.nodes(); ++node)
    for (int which = 0; which < 4; ++which) {
      const int unknown = bridge.unknown(node, which), local = unknown < 0 ? -1 : beam()->local(unknown);
      if (local >= 0) w[local] = 0.0;
    }
}

// Creates the fleet with all drives at rest and all bodies at the positions of the scene.
void System::freeze_fleet(const train::Train& train) {
  fleet_ = train::Fleet(input_.types, train, input_.gravity, true, line_ != nullptr ? &line_->mesh : nullptr,
                        &input_.profile, surface_height(), uses_local_compliance());
  fleet_.partition(0.0);
  const int f = fleet_.freedom();
  p_.assign(2 * static_cast<std::size_t>(f), 0.0);
  for (std::vector<double>* predicted : {&p_predicted_, &pd_predicted_, &x_}) predicted->assign(f, 0.0);
  fleet_.place_wheels();
  fleet_.set_static_penetrations();
}

// Statics from p_predicted_. `tie`: stiffness per mass of the springs that tie all masses to their positions, 1/s2.
System::Solution System::solve_statics(double tie, bool with_fleet) {
  if (structure_) structure_->begin_statics(structure_->deformed_without_traffic() || !loads_.empty());
  return solve_coupled({0.0, 0.0, tie}, with_fleet);
}

// Newton's method does not converge from a loose spring or an open contact to a loaded one, because the force has no
// slope there; continuation with decreasing ties converges.
System::Solution System::solve_statics_slowly() {
  const train::Fleet start = fleet_;
  Solution found = Solution::fleet_failed;
  double tie = first_tie;
  for (int i = 0; i < most_ties && tie >= last_tie; ++i) {
    found = solve_statics(tie);
    if (found == Solution::structure_failed) return found;
    if (found == Solution::fleet_failed) {
      if ((tie *= stiffer) > rigid_tie) return found;
      restart_from(p_predicted_);
      continue;
    }
    double tie_acceleration = 0.0;
    for (const double x : x_) tie_acceleration = std::max(tie_acceleration, tie * std::abs(x));
    restart_from(p_);
    unsupported_ = fleet_.unsupported_body(start);
    if (!unsupported_.empty()) return Solution::fleet_failed;
    tie *= softer;
    if (tie_acceleration > balanced_acceleration * std::max(input_.gravity, 1.0)) continue;
    const std::vector<double> last_positions = p_predicted_;
    if (solve_statics() == Solution::found) return Solution::found;
    restart_from(last_positions);
  }
  return Solution::fleet_failed;
}

// Sets the fleet to the positions p, with well conditioned independent coordinates.
void System::restart_from(std::vector<double> p) {
  const auto f = static_cast<std::ptrdiff_t>(fleet_.freedom());
  std::copy_n(p.begin(), f, p_predicted_.begin());
  std::fill(x_.begin(), x_.end(), 0.0);
  if (!fleet_.set(0.0, p_predicted_.data(), pd_predicted_.data()) || !fleet_.badly_conditioned() || !fleet_.accept())
    return;
  fleet_.assign_coordinates(0.0);
  std::fill(p_predicted_.begin(), p_predicted_.end(), 0.0);
}

void System::throw_no_equilibrium(Solution found) const {
  if (found == Solution::structure_failed)
    throw SolverError(
        "no static equilibrium found to start from: the foundation that is one-sided, slides, has a gap or "
        "a cubic term does not settle, worst " +
        structure_->failure_reason() + "; does the beam rest on it, and what else holds the beam?");
  const std::string advice =
      "is every body held by joints, springs or wheels, also against actuators, and every wheel stiff enough to carry "
      "its load within its radius? scene_start: given starts from the positions as written";
  for (const train::WheelContact& c : fleet_.wheels) {
    const Eigen::Vector3d q = fleet_.coordinates(c);
    const double below = fleet_.profile(c).at(q.x()).value - q.y();
    if (newton_.last_change() == 0.0 && below >= 0.0)
      throw SolverError(
          fmt::format("no static equilibrium found to start from: the centre of wheel '{}' of vehicle "
                      "'{}' stands {:g} m below the track's surface, on which it rolls at the height of "
                      "its radius, {:g} m (position of its body)",
                      fleet_.wheel(c).name, fleet_.vehicles[c.vehicle].name(), below, fleet_.wheel(c).radius));
  }
  if (!unsupported_.empty())
    throw SolverError("no static equilibrium found to start from: " + unsupported_ + "; " + advice);
  throw SolverError(
      fmt::format("no static equilibrium found to start from (forces out of balance by {:g} of a "
                  "vehicle's weight, worst in vehicle '{}'): {}",
                  newton_.last_change(), fleet_.vehicles[newton_.worst_vehicle()].name(), advice));
}

}  // namespace traverse::coupling
