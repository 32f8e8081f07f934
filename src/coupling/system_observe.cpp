// What is seen of an accepted state: accelerations, loads, forces, energies.
#include <algorithm>

#include "traverse/coupling/system.hpp"

namespace traverse::coupling {

void System::observe(double t, const double* y, const double* ydot, Observation& out) {
  evaluate_fleet(t, y);
  out.a.assign(ydot + n_, ydot + 2 * n_);
  out.P.resize(n_);
  out.loads.clear();
  out.bridge_loads.clear();
  if (beam_ != nullptr) {
    external_load(t, out.P.data());
    add_contact_load(out.P.data());
    out.loads = loads_;
    for (const WheelContact& c : fleet_.wheels) {
      if (c.slot() < 0 || c.force.normal == 0.0) continue;
      const Eigen::Vector3d f = c.force.normal * c.touch.normal_on_body + c.force.tangential * c.touch.tangent_on_body;
      const double speed = fleet_.vehicles[c.vehicle].state.qd[3 * static_cast<Eigen::Index>(c.body)];
      out.loads.push_back({c.patches[c.active].element, c.touch.xi, f.x(), f.y(), -surface_height() * f.x(), speed});
    }
    if (beam_->rail() == nullptr) out.bridge_loads = out.loads;
    if (nonlinear_) {
      nonlinear_->evaluate(y, y + n_);
      nonlinear_->add_forces(out.P.data());
      nonlinear_->report(out.foundation, out.bridge_loads);
    }
  }
  out.energy = energy(y);
}

Energy System::energy(const double* y) {
  const double* v = y;
  const double* w = y + n_;
  double sums[5] = {0.0, 0.0, 0.0, 0.0, 0.0};  // beam kinetic, strain, potential of its weight; D, W
  if (beam_ != nullptr) {
    operator_->multiply(1.0, w, nullptr, nullptr, work_.data());
    for (int i = 0; i < n_; ++i) sums[0] += 0.5 * w[i] * work_[i];
    operator_->multiply(1.0, nullptr, nullptr, v, work_.data());
    for (int i = 0; i < n_; ++i) {
      sums[1] += 0.5 * v[i] * work_[i];
      sums[2] -= v[i] * dead_load_[i];
    }
    if (nonlinear_) sums[1] += nonlinear_->energy();
  }
  if (motion_) {
    const bool fused = motion_->beam && motion_->beam->fused();
    sums[3] = fused ? dissipated_until(measure_dissipation(w)) : motion_->dissipated;
    if (motion_->window) sums[3] += motion_->window->energy_left();
    sums[4] = motion_->worked;
  }
  if (rank_ == 0) {
    sums[3] += y[2 * (n_ + fleet_.freedom())];
    sums[4] += y[2 * (n_ + fleet_.freedom()) + 1];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 5, MPI_DOUBLE, MPI_SUM, comm_);
  Energy e{sums[0], sums[1], sums[2], sums[3], sums[4], sums[0] + sums[1]};
  for (const MovingVehicle& vehicle : fleet_.vehicles) {
    const multibody::MechanismEnergy m = vehicle.mechanism.energy(vehicle.state);
    e.kinetic += m.kinetic;
    e.strain += m.strain;
    e.potential += m.potential;
  }
  e.potential += fleet_.contact_potential();
  return e;
}

}  // namespace traverse::coupling
