// Residual B^T (N q'' - g - Q) of a mechanism in its independent coordinates (equation 42 of the paper) and its Newton
// matrix, with and without joint friction. Contact directions and residuals are right-hand sides of the augmented
// equations of a mechanism.
#include "multibody_dynamics.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::train {
namespace {

// 1/s2: in statics springs tie all masses, because coordinates such as the rotation of a roller may have no stiffness.
// Newton's method loses a part of 1e-4 s2 times the square of a frequency, no accuracy.
constexpr double static_tie = 1e-4;

double dot3(const std::array<double, 3>& a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::array<double, 3> array3(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace

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

double AugmentedNewton::Direction::dot(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  const double first = dot3(on_body, q.data() + 3 * static_cast<std::ptrdiff_t>(body));
  return other == multibody::ground ? first : first + dot3(on_other, q.data() + 3 * static_cast<std::ptrdiff_t>(other));
}

void AugmentedNewton::Direction::add_to(double force, Eigen::VectorXd& r) const {
  for (int c = 0; c < 3; ++c) {
    r[3 * body + c] += force * on_body[c];
    if (other != multibody::ground) r[3 * other + c] += force * on_other[c];
  }
}

AugmentedNewton::Direction AugmentedNewton::direction_of(const ContactRow& row) {
  const Contact& c = *row.contact;
  Direction d;
  d.body = c.body;
  d.other = c.other_body;
  d.on_body = array3(row.normal ? c.touch.normal_on_body : c.touch.tangent_on_body);
  if (d.other != multibody::ground)
    d.on_other = array3(row.normal ? c.touch.normal_on_other : c.touch.tangent_on_other);
  return d;
}

bool AugmentedNewton::renew(MovingVehicle& vehicle, const StageShifts& shifts, const double* pdd, ContactRows rows,
                            ContactCompliance& compliance) {
  const multibody::Mechanism& mechanism = vehicle.mechanism;
  if (!system_.planned() || partition_version_ != vehicle.state.partition_version) {
    system_.plan(mechanism.augmented_pattern());
    partition_version_ = vehicle.state.partition_version;
    independent_ = mechanism.partition().independent;
  }
  if (pdd != nullptr) mechanism.recover(vehicle.state, vehicle.Q, pdd);
  directions_.resize(rows.size());
  std::transform(rows.begin(), rows.end(), directions_.begin(), direction_of);
  const double by_mass = shifts.statics() ? static_tie : shifts.acceleration;
  mechanism.assemble_augmented(vehicle.state, by_mass, -1.0, -shifts.rate, pdd != nullptr ? 1.0 : 0.0, system_);
  if (shifts.statics()) add_contacts(compliance.D);
  if (!system_.factor()) return false;
  dq_.resize(mechanism.coordinates());
  const auto r = static_cast<Eigen::Index>(rows.size());
  compliance.H.resize(r, r);
  compliance.c.resize(r);
  for (Eigen::Index j = 0; j < r; ++j) {
    dq_.setZero(mechanism.coordinates());
    directions_[static_cast<std::size_t>(j)].add_to(1.0, dq_);
    system_.solve(dq_);
    for (Eigen::Index i = 0; i < r; ++i) compliance.H(i, j) = directions_[static_cast<std::size_t>(i)].dot(dq_);
  }
  return true;
}

// K += G^T D G. The first column of D belongs to tangential rows.
void AugmentedNewton::add_contacts(const RowTangent& D) {
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const Direction& own = directions_[i];
    const auto row = static_cast<Eigen::Index>(i);
    system_.add_to_body(own.body, D(row, 1), own.on_body, own.on_body);
    if (D(row, 0) != 0.0) system_.add_to_body(own.body, D(row, 0), own.on_body, directions_[i - 1].on_body);
  }
}

// R is a residual of all coordinates whose projection is R: with R at the independent ones and 0 at the others.
void AugmentedNewton::compute_free_displacement(const Eigen::VectorXd& R, ContactCompliance& compliance) {
  dq_.setZero();
  for (std::size_t k = 0; k < independent_.size(); ++k) dq_[independent_[k]] = -R[static_cast<Eigen::Index>(k)];
  system_.solve(dq_);
  for (std::size_t i = 0; i < directions_.size(); ++i)
    compliance.c[static_cast<Eigen::Index>(i)] = directions_[i].dot(dq_);
}

const Eigen::VectorXd& AugmentedNewton::coordinate_change(const Eigen::VectorXd& forces) {
  if (forces.size() > 0) {
    by_forces_.setZero(dq_.size());
    for (Eigen::Index i = 0; i < forces.size(); ++i)
      directions_[static_cast<std::size_t>(i)].add_to(-forces[i], by_forces_);
    system_.solve(by_forces_);
    dq_ += by_forces_;
  }
  dx_.resize(static_cast<Eigen::Index>(independent_.size()));
  for (std::size_t k = 0; k < independent_.size(); ++k) dx_[static_cast<Eigen::Index>(k)] = dq_[independent_[k]];
  return dx_;
}

}  // namespace traverse::train
