// Accepted steps and the contacts lost and gained in them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "traverse/coupling/system.hpp"

namespace traverse::coupling {
namespace {

constexpr double same_place = 1e-9;  // m or rad: a step's last stage is its end

}  // namespace

void System::begin_trial() {
  for (int i = 0; i < fleet_.contacts(); ++i) fleet_.contact(i).touched = false;
}

void System::note_touched() {
  for (int i = 0; i < fleet_.contacts(); ++i)
    if (fleet_.contact(i).force.normal > 0.0) fleet_.contact(i).touched = true;
}

void System::arrive(double t, const double* y) {
  const int f = fleet_.freedom();
  evaluated_.assign(p_.begin(), p_.begin() + f);
  if (motion_) {
    std::copy(motion_->p.begin(), motion_->p.end(), p_.begin());
    std::copy(motion_->pd.begin(), motion_->pd.end(), p_.begin() + f);
  } else {
    share_coordinates(y);
  }
  double moved = 0.0;
  for (int i = 0; i < f; ++i) moved = std::max(moved, std::abs(p_[i] - evaluated_[i]));
  if (t != evaluated_time_ || moved > same_place) evaluate_fleet(t, y);
}

bool System::accept(double t, double* y) {
  if (motion_) complete_step(y);
  if (fleet_.vehicles.empty()) return false;
  arrive(t, y);
  const double lost = note_contacts(t);
  if (fleet_.worn()) evaluate_fleet(t, y);
  const bool renewed = fleet_.accept(t);
  if (rank_ == 0) y[2 * (n_ + fleet_.freedom())] += lost;
  if (!renewed) return lost != 0.0;
  if (rank_ == 0) fleet_.coordinates_of_state(t, y + 2 * n_, y + 2 * n_ + fleet_.freedom());
  return true;
}

// Contacts lost and gained, the speeds with which they approach, the impacts that begin or are to come. Returns the
// energy that goes where a damper lets go of a surface not yet back, J.
double System::note_contacts(double t) {
  double lost = 0.0;
  for (int i = 0; i < static_cast<int>(impacts_.size()); ++i) {
    if (fleet_.has_points(i)) continue;
    Contact& c = fleet_.contact(i);
    const bool touches = fleet_.touches(i);
    const double stored = contact::potential(c.law, c.kinematics.penetration);
    if (separations_.touching(i) && !touches) {
      c.released = true;
      lost += stored;
    } else if (c.released && (touches || stored == 0.0)) {
      c.released = false;
      lost -= stored;
    }
  }
  separations_.accept(fleet_, t);
  fleet_.note_sides();
  impacts_.resize(static_cast<std::size_t>(fleet_.contacts()));
  for (int i = 0; i < fleet_.contacts(); ++i) {
    Contact& c = fleet_.contact(i);
    Impact& impact = impacts_[i];
    const bool touching = separations_.touching(i);
    if (touching && !separations_.met(i)) continue;
    c.approach_speed = std::max(c.kinematics.penetration_rate, 0.0);
    impact = {};
    if (input_.impact_steps == 0 || c.approach_speed == 0.0) continue;
    const double duration = fleet_.impact_duration(i);
    impact.step = duration / input_.impact_steps;
    if (touching) impact.end = t + 2.0 * duration;
  }
  return lost;
}

std::optional<Change> System::contact_change(double t, double tolerance) const {
  return separations_.change(
      fleet_, t, [&](int i) { return separations_.time_to_touch(i) <= 2.0 * change_tolerance(i, tolerance); });
}

// A damper comes on with a jump, which must lie at a step's border; an elastic force grows from nothing.
double System::change_tolerance(int contact, double tolerance) const {
  const Contact& c = fleet_.contact(contact);
  const double step = impacts_[contact].step;
  if (c.law.hysteresis || c.law.damping == 0.0) return std::min(tolerance, 0.1 * step);
  // a step of twice as much leads from this side of the damper's ramp beyond it
  const double ramp = c.approach_speed > 0.0 ? contact::damper_ramp / c.approach_speed : 0.0;
  return std::min(tolerance, std::max(1e-3 * step, std::min(ramp, 0.1 * step)));
}

double System::step_limit(double t, double tolerance) const {
  double limit = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(impacts_.size()); ++i) {
    const double across = 2.0 * change_tolerance(i, tolerance);
    const double to_touch = separations_.time_to_touch(i);
    if (t < impacts_[i].end) limit = std::min(limit, impacts_[i].step);
    if (tolerance > 0.0) limit = std::min(limit, std::max(to_touch, across));
  }
  return limit;
}

std::string System::trouble() const {
  for (const MovingVehicle& vehicle : fleet_.vehicles)
    if (vehicle.state.friction.jammed) return vehicle.mechanism.jam(vehicle.state);
  const MovingVehicle* stuck = fleet_.stuck();
  if (stuck == nullptr)
    return "the contact iteration does not converge: try a smaller -ts_dt, softer contacts, or look at the state just "
           "before";
  const multibody::Mechanism& mechanism = stuck->mechanism;
  return "vehicle '" + mechanism.model().name + "' is locked: " + mechanism.worst_row(stuck->state) +
         ", wherever else its bodies go; a driver pulls it beyond its reach or through a dead point";
}

}  // namespace traverse::coupling
