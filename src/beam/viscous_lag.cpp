#include "traverse/beam/viscous_lag.hpp"

#include <cmath>

namespace traverse::beam {

// m + b dm/dt = c exactly, for c that is linear in time.
void ViscousLag::follow(double& force, double nodal, Inner& inner) const {
  const double c = force - nodal;
  if (interval_ > 0.0) {
    const double late = b_ * (c - inner.c) / interval_;
    inner.m = c - late + (inner.m - inner.c + late) * decay_;
  }
  inner.c = c;
  force = nodal + inner.m;
}

void ViscousLag::apply(double t, std::vector<Response>& responses) {
  const bool first = inner_.empty();
  interval_ = first ? 0.0 : t - time_;
  decay_ = std::exp(-interval_ / b_);
  time_ = t;
  if (first) inner_.resize(responses.size());
  for (std::size_t i = 0; i < responses.size(); ++i) {
    Response& r = responses[i];
    auto& [moment, shear, axial] = inner_[i];
    if (first) {
      moment.m = r.moment - r.nodal_moment;
      shear.m = r.shear - r.nodal_shear;
      axial.m = r.axial_force - r.nodal_axial_force;
    }
    follow(r.moment, r.nodal_moment, moment);
    follow(r.shear, r.nodal_shear, shear);
    follow(r.axial_force, r.nodal_axial_force, axial);
    r.moment_rate = r.nodal_moment_rate + (moment.c - moment.m) / b_;
  }
}

}  // namespace traverse::beam
