// The static equilibrium that a run starts from.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "coupling/system.hpp"

namespace traverse::coupling {
namespace {

// Of the way to rest where Newton finds none at once: all masses are tied to where they are by springs whose frequency
// squared, 1/s2, falls from step to step, and the ties follow. What nothing carries yet goes down until something does.
constexpr double first_tie = 1e3, last_tie = 1e-2;
constexpr double softer = 0.5, stiffer = 8.0;  // after a step, and after one that has no solution
constexpr int most_ties = 200;
constexpr double nearly_at_rest = 0.02;  // of gravity: what the ties still hold
constexpr double a_little = 1e-3;        // m: to either side, to see how the rail's deflection goes along with a train
constexpr double held_fast = 1e10;       // 1/s2, of a tie

}  // namespace

// The stage problem at shift 0 with every drive standing still: the structure and the vehicles at rest.
void System::find_equilibrium(double* y) {
  train::Fleet moving = std::move(fleet_);
  stand_still(input_.train);
  if (structure_) load_structure(0.0);
  Solution found = solve_statics(Terms::all);
  if (found == Solution::fleet_unsettled) {
    stand_still(input_.train);
    found = solve_statics_slowly();
  }
  if (found != Solution::found) refuse_start(found);
  if (structure_) structure_->end_stage(y, y + n_);
  fleet_.set(0.0, p_.data(), pd_predicted_.data());
  moving.rest_where(fleet_);
  fleet_ = std::move(moving);
}

// Wheels on a rail begin with its deflection under them, which goes along with them: rail, sleepers and ballast at its
// velocity, by how they lie under the wheels a little before and behind at the same height. A rail that had to be set
// going first would throw the wheels up, by 7 % of their weight at 300 km/h. The bridge has no time to follow that: it
// begins at rest.
void System::go_with_the_train(double* w) {
  const double speed = fleet_.wheels.empty() ? 0.0 : law_of_wheel(0).speed(0.0);
  if (!structure_ || beam()->rail() == nullptr || speed == 0.0) return;
  train::Fleet moving = std::move(fleet_);
  std::array<std::vector<double>, 2> v;
  bool found = true;
  for (const std::size_t after : {0, 1}) {
    const double ahead = after == 1 ? a_little : -a_little;
    train::Train train = input_.train;
    for (double& x : train.positions) x += ahead;
    stand_still(train);
    fleet_.rest_where(moving);
    for (train::MovingVehicle& vehicle : fleet_.vehicles)
      for (Eigen::Index i = 0; i < vehicle.state.q.size(); i += 3) vehicle.state.q[i] += ahead;
    fleet_.coordinates_of_state(0.0, p_predicted_.data(), pd_predicted_.data());
    load_structure(ahead / speed);
    found = found && solve_statics(Terms::all, held_fast) == Solution::found;
    v[after].resize(static_cast<std::size_t>(n_));
    structure_->end_stage(v[after].data(), w);
  }
  fleet_ = std::move(moving);
  load_structure(0.0);
  const double rate = found ? speed / (2.0 * a_little) : 0.0;
  for (int i = 0; i < n_; ++i) w[i] = rate * (v[1][i] - v[0][i]);
  const beam::Line& bridge = beam()->bridge();
  for (int node = 0; node < bridge.mesh.nodes(); ++node)
    for (int which = 0; which < 4; ++which) {
      const int unknown = bridge.unknown(node, which), local = unknown < 0 ? -1 : beam()->local(unknown);
      if (local >= 0) w[local] = 0.0;
    }
}

// Every drive stands still, every body is where the scene puts it.
void System::stand_still(const train::Train& train) {
  fleet_ = train::Fleet(input_.types, train, input_.gravity, true, line_ != nullptr ? &line_->mesh : nullptr,
                        &input_.profile, surface_height(), yields_inside());
  fleet_.partition(0.0);
  const int f = fleet_.freedom();
  p_.assign(2 * static_cast<std::size_t>(f), 0.0);
  for (std::vector<double>* predicted : {&p_predicted_, &pd_predicted_, &x_}) predicted->assign(f, 0.0);
  if (structure_) fleet_.place_wheels();
}

// Statics, from p_still_. `tie`: what holds all masses where they are, 1/s2.
System::Solution System::solve_statics(Terms terms, double tie) {
  if (structure_) structure_->begin_statics(structure_->bent_at_rest() || !loads_.empty());
  return solve_coupled({0.0, 0.0, tie}, terms);
}

// Newton does not come from a spring that is loose, or a contact that is apart, to where it carries: the force has no
// slope to follow.
System::Solution System::solve_statics_slowly() {
  const train::Fleet start = fleet_;
  Solution found = Solution::fleet_unsettled;
  double tie = first_tie;
  for (int i = 0; i < most_ties && tie >= last_tie; ++i) {
    found = solve_statics(Terms::all, tie);
    if (found == Solution::structure_unsettled) return found;
    if (found == Solution::fleet_unsettled) {
      if ((tie *= stiffer) > first_tie * stiffer) return found;
      go_on_from(p_predicted_);
      continue;
    }
    double held = 0.0;
    for (const double x : x_) held = std::max(held, tie * std::abs(x));
    go_on_from(p_);
    nothing_holds_ = fleet_.lost_since(start);
    if (!nothing_holds_.empty()) return Solution::fleet_unsettled;
    tie *= softer;
    if (held > nearly_at_rest * std::max(input_.gravity, 1.0)) continue;
    const std::vector<double> here = p_predicted_;
    if (solve_statics(Terms::all) == Solution::found) return Solution::found;
    go_on_from(here);
  }
  return Solution::fleet_unsettled;
}

// The fleet to the positions p, by coordinates that serve there.
void System::go_on_from(std::vector<double> p) {
  const auto f = static_cast<std::ptrdiff_t>(fleet_.freedom());
  std::copy_n(p.begin(), f, p_predicted_.begin());
  std::fill(x_.begin(), x_.end(), 0.0);
  if (!fleet_.set(0.0, p_predicted_.data(), pd_predicted_.data()) || !fleet_.worn() || !fleet_.accept()) return;
  fleet_.number(0.0);
  std::fill(p_predicted_.begin(), p_predicted_.end(), 0.0);
}

void System::refuse_start(Solution found) const {
  if (found == Solution::structure_unsettled)
    throw SolverError(
        "no static equilibrium found to start from: the foundation that is one-sided, slides, has a gap or "
        "a cubic term does not settle, worst " +
        structure_->trouble() + "; does the beam rest on it, and what else holds the beam?");
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
  if (!nothing_holds_.empty())
    throw SolverError("no static equilibrium found to start from: " + nothing_holds_ + "; " + advice);
  throw SolverError(
      fmt::format("no static equilibrium found to start from (forces out of balance by {:g} of a "
                  "vehicle's weight, worst in vehicle '{}'): {}",
                  newton_.last_change(), fleet_.vehicles[newton_.worst_vehicle()].name(), advice));
}

}  // namespace traverse::coupling
