// Accepted steps and the contacts lost and gained in them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "traverse/coupling/system.hpp"

namespace traverse::coupling {
namespace {

constexpr double same_place = 1e-9;  // m or rad

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
  bool moved = (signs_ & train::VehicleShare::moved) != 0;
  if (!motion_) {
    evaluated_.assign(p_.begin(), p_.begin() + f);
    share_coordinates(y);
    for (int i = 0; i < f; ++i) moved = moved || std::abs(p_[i] - evaluated_[i]) > same_place;
  }
  if (t != evaluated_time_ || moved) evaluate_fleet(t, y);
}

bool System::accept(double t, double* y) {
  if (motion_ && structure_) structure_->complete_step(y, y + n_);
  if (fleet_.vehicles.empty()) return false;
  arrive(t, y);
  const double lost = note_contacts(t);
  const bool worn = share_.dealt() ? (signs_ & train::VehicleShare::worn) != 0 : fleet_.worn();
  if (worn) evaluate_fleet(t, y);
  bool renewed = fleet_.accept();
  if (worn && share_.dealt()) {
    renewed = share_.exchange(renewed ? train::VehicleShare::renewed : 0U) != 0;
    if (renewed) share_.partitions(fleet_);
  }
  if (renewed) fleet_.number(t);
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
    train::Contact& c = fleet_.contact(i);
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
  note_impacts(t);
  return lost;
}

void System::note_impacts(double t) {
  impacts_.resize(static_cast<std::size_t>(fleet_.contacts()));
  impact_durations_.assign(impacts_.size(), 0.0);
  bool any = false;
  for (int i = 0; i < fleet_.contacts(); ++i) {
    train::Contact& c = fleet_.contact(i);
    if (separations_.touching(i) && !separations_.met(i)) continue;
    c.approach_speed = std::max(c.kinematics.penetration_rate, 0.0);
    impacts_[i] = {};
    if (input_.impact_steps == 0 || c.approach_speed == 0.0) continue;
    any = true;
    if (fleet_.owns(c)) impact_durations_[i] = fleet_.impact_duration(i);
  }
  if (!any) return;
  if (share_.dealt())
    MPI_Allreduce(MPI_IN_PLACE, impact_durations_.data(), fleet_.contacts(), MPI_DOUBLE, MPI_MAX, comm_);
  for (std::size_t i = 0; i < impacts_.size(); ++i) {
    if (impact_durations_[i] == 0.0) continue;
    impacts_[i].step = impact_durations_[i] / input_.impact_steps;
    if (separations_.touching(static_cast<int>(i))) impacts_[i].end = t + 2.0 * impact_durations_[i];
  }
}

std::optional<train::Change> System::contact_change(double t, double tolerance) const {
  return separations_.change(
      fleet_, t, [&](int i) { return separations_.time_to_touch(i) <= 2.0 * change_tolerance(i, tolerance); });
}

// A damper comes on with a jump, which must lie at a step's border; an elastic force grows from nothing.
double System::change_tolerance(int contact, double tolerance) const {
  const train::Contact& c = fleet_.contact(contact);
  const double step = impacts_[contact].step;
  if (c.law.hysteresis || c.law.damping == 0.0) return std::min(tolerance, 0.1 * step);
  // a step of twice as much leads from this side of the damper's ramp beyond it
  const double ramp = c.approach_speed > 0.0 ? contact::damper_ramp / c.approach_speed : 0.0;
  return std::min(tolerance, std::max(1e-3 * step, std::min(ramp, 0.1 * step)));
}

double System::step_limit(double t) const {
  double limit = std::numeric_limits<double>::infinity();
  for (const Impact& impact : impacts_)
    if (t < impact.end) limit = std::min(limit, impact.step);
  return limit;
}

double System::time_to_impact(double tolerance) const {
  double time = std::numeric_limits<double>::infinity();
  if (tolerance == 0.0) return time;
  for (int i = 0; i < static_cast<int>(impacts_.size()); ++i)
    time = std::min(time, std::max(separations_.time_to_touch(i), 2.0 * change_tolerance(i, tolerance)));
  return time;
}

std::string System::trouble() const {
  std::string text = fleet_.trouble();
  if (share_.dealt()) {  // the first rank that has some tells the others
    std::array<int, 2> teller = {text.empty() ? ranks_ : rank_, 0};
    MPI_Allreduce(MPI_IN_PLACE, teller.data(), 1, MPI_INT, MPI_MIN, comm_);
    if (teller[0] < ranks_) {
      teller[1] = static_cast<int>(text.size());
      MPI_Bcast(&teller[1], 1, MPI_INT, teller[0], comm_);
      text.resize(static_cast<std::size_t>(teller[1]));
      MPI_Bcast(text.data(), teller[1], MPI_CHAR, teller[0], comm_);
    }
  }
  if (!text.empty()) return text;
  return "the contact iteration does not converge: try a smaller -ts_dt, softer contacts, or look at the state just "
         "before";
}

}  // namespace traverse::coupling
