// Steps that are taken apart (stepped_apart.hpp).
#include <algorithm>

#include "coupling/system.hpp"

namespace traverse::coupling {

bool System::try_apart(double t, double h, double* y) {
  if (apart_->step(t, h)) return true;
  fetch(y);
  defect_apart_ = apart_->defect();
  apart_.reset();
  if (motion_) share_.deal(comm_, fleet_);  // else begin_motion does
  evaluate_fleet(t, y);
  events_.accept(t);
  return false;
}

void System::fetch(double* y) {
  if (!apart_ || rank_ != 0) return;
  apart_->tell(y);
  if (!motion_) return;  // no step was taken yet
  motion_->dissipated = apart_->dissipated();
  motion_->worked = apart_->worked();
}

bool System::fetch_rate(double t, const double* y, double* ydot) {
  if (!apart_) return false;
  evaluate_fleet(t, y);
  return apart_->tell_rate(contact_loads(), ydot);
}

// Places and forces of the wheels, for those who look at them after every step.
void System::note_wheels_apart() {
  for (std::size_t i = 0; i < fleet_.wheels.size(); ++i) {
    const SteppedApart::Wheel wheel = apart_->wheel(i);
    fleet_.wheels[i].force.normal = wheel.force;
    fleet_.x(fleet_.wheels[i]) = wheel.x;
  }
}

}  // namespace traverse::coupling
