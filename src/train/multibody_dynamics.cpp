// Residual B^T (N q'' - g - Q) of a mechanism in its independent coordinates (equation 42 of the paper) and its Newton
// matrix, with and without joint friction.
#include "multibody_dynamics.hpp"

#include <cmath>

namespace traverse::train {
bool MultibodyDynamics::set(MovingVehicle& vehicle, double t, const double* p, const double* pd) {
  if (!vehicle.mechanism.set_positions(vehicle.state, t, p)) return false;
  vehicle.mechanism.set_velocities(vehicle.state, t, pd);
  vehicle.mechanism.compute_forces(vehicle.state);
  return true;
}

void MultibodyDynamics::shift(MovingVehicle& vehicle, const double* change, double rate) {
  vehicle.mechanism.shift(vehicle.state, change, rate);
}

void MultibodyDynamics::accelerations(MovingVehicle& vehicle, double* pdd) {
  vehicle.mechanism.accelerations(vehicle.state, vehicle.Q, pdd);
}

void MultibodyDynamics::recover(MovingVehicle& vehicle, const double* pdd) {
  vehicle.mechanism.recover(vehicle.state, vehicle.Q, pdd);
}

bool MultibodyDynamics::accept(MovingVehicle& vehicle) {
  const bool renewed = vehicle.mechanism.renew_partition(vehicle.state);
  vehicle.mechanism.accept(vehicle.state);
  return renewed;
}

// R = B^T (N q'' - g - Q).
bool MultibodyDynamics::find_residual(MovingVehicle& vehicle, const double* pdd, ContactCompliance& compliance) {
  multibody::MechanismState& state = vehicle.state;
  const multibody::Mechanism& mechanism = vehicle.mechanism;
  pdd_ = Eigen::Map<const Eigen::VectorXd>(pdd, mechanism.freedom());
  r_ = state.d;
  state.dependent_block.expand(pdd, r_);
  r_ = mechanism.mass_diagonal().cwiseProduct(r_) - state.g - vehicle.Q;
  if (mechanism.has_friction()) {
    mechanism.recover(state, vehicle.Q, pdd);
    for (int i = 0; i < state.friction.force.size(); ++i) r_ -= state.friction.force[i] * state.friction.A.col(i);
  }
  R_.resize(mechanism.freedom());
  state.dependent_block.project(r_, R_);
  compliance.residual = R_.size() > 0 ? R_.lpNorm<Eigen::Infinity>() / vehicle.scale : 0.0;
  return !state.friction.jammed;
}

// With contacts between bodies nothing is reused, because the contacts turn with the bodies.
bool MultibodyDynamics::matrix_is_valid(const MovingVehicle& vehicle, const StageShifts& shifts, bool curved) const {
  return !shifts.statics() && !vehicle.mechanism.has_friction() && vehicle.contacts.empty() &&
         partition_version_ == vehicle.state.partition_version && (curved_ || !curved) && shifts_.like(shifts);
}

void MultibodyDynamics::compute_J(MovingVehicle& vehicle, const StageShifts& shifts, bool curved) {
  multibody::MechanismState& state = vehicle.state;
  const multibody::Mechanism& mechanism = vehicle.mechanism;
  const int f = mechanism.freedom();
  if (mechanism.has_friction())
    mechanism.friction_projector(state, projector_);
  else if (curved)
    mechanism.recover(state, vehicle.Q, pdd_.data());
  mechanism.multiply_tangent(state, -1.0, -shifts.rate, curved ? 1.0 : 0.0, NB_);
  for (std::size_t b = 0; b < state.columns.size(); ++b) {
    const auto [first, last] = state.columns[b];
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(b);
    NB_.block(row, first, 3, last - first) += shifts.acceleration *
                                              mechanism.mass_diagonal().segment<3>(row).asDiagonal() *
                                              state.B.block(row, first, 3, last - first);
  }
  J_.resize(f, f);
  if (mechanism.has_friction()) {  // changes too much to be reused
    J_.noalias() = projector_.transpose() * NB_;
  } else {
    for (int j = 0; j < f; ++j) state.dependent_block.project(NB_.col(j), J_.col(j));
  }
}

void MultibodyDynamics::renew(MovingVehicle& vehicle, const StageShifts& shifts, bool curved, ContactRows rows,
                              ContactCompliance& compliance) {
  multibody::MechanismState& state = vehicle.state;
  const bool has_friction = vehicle.mechanism.has_friction(), constrained = vehicle.mechanism.constraints() > 0;
  curved_ = curved || has_friction || !constrained;
  shifts_ = shifts;
  partition_version_ = state.partition_version;
  is_augmented_ = state.dependent_block.many_sensitivities() && !has_friction &&
                  !(shifts.statics() && !vehicle.contacts.empty()) &&
                  augmented_.renew(vehicle, shifts, curved ? pdd_.data() : nullptr, rows, compliance);
  if (is_augmented_) return;
  vehicle.mechanism.compute_B(state);
  compute_J(vehicle, shifts, (curved || has_friction) && constrained);
  if (has_friction) {
    all_columns_.assign(state.columns.size(), {0, vehicle.freedom()});
    VehicleNewton::multiply_directions(rows, all_columns_, projector_, projected_);
  }
  newton_.renew(rows, state.columns, state.B, has_friction ? &projected_ : nullptr, shifts.statics(), J_, compliance);
}

}  // namespace traverse::train
