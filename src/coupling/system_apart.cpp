// Steps that are taken apart (stepped_apart.hpp).
#include <algorithm>

#include "coupling/system.hpp"

namespace traverse::coupling {

bool System::try_apart(double t, double h, double* y) {
  if (apart_->step(t, h)) return true;
  fetch(y);
  defect_apart_ = apart_->defect();
  apart_.reset();
  share_.deal(comm_, fleet_);
  evaluate_fleet(t, y);
  events_.accept(t);
  return false;
}

void System::fetch(double* y) {
  if (!apart_) return;
  if (rank_ != 0) return;
  apart_->tell(y);
  motion_->dissipated = apart_->dissipated();
  motion_->worked = apart_->worked();
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
