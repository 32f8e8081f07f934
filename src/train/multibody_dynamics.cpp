#include "multibody_dynamics.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::train {
namespace {

constexpr double same_shift = 1e-6;  // relative

bool same(double a, double b) { return std::abs(a - b) <= same_shift * b; }

// Contact directions times B, whose rows of a body reach into the columns given.
template <class RowMatrix>
void multiply_directions(ContactRows rows, const std::vector<multibody::ColumnRange>& columns, const Eigen::MatrixXd& B,
                         RowMatrix& G) {
  G.setZero(static_cast<Eigen::Index>(rows.size()), B.cols());
  for (int i = 0; i < G.rows(); ++i) {
    const ContactRow& row = rows[static_cast<std::size_t>(i)];
    const Contact& c = *row.contact;
    const auto add = [&](int body, const Eigen::Vector3d& direction) {
      const auto [first, last] = columns[body];
      G.row(i).segment(first, last - first).noalias() +=
          direction.transpose() * B.block(3 * static_cast<Eigen::Index>(body), first, 3, last - first);
    };
    add(c.body, row.normal ? c.touch.normal_on_body : c.touch.tangent_on_body);
    if (c.other_body != multibody::ground)
      add(c.other_body, row.normal ? c.touch.normal_on_other : c.touch.tangent_on_other);
  }
}

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
bool MultibodyDynamics::find_residual(MovingVehicle& vehicle, const double* pdd, VehicleYield& yield) {
  multibody::MechanismState& state = vehicle.state;
  const multibody::Mechanism& mechanism = vehicle.mechanism;
  pdd_ = Eigen::Map<const Eigen::VectorXd>(pdd, mechanism.freedom());
  r_ = state.d;
  state.dependent_block.expand(pdd, r_);
  r_ = mechanism.mass_diagonal().cwiseProduct(r_) - state.g - vehicle.Q;
  if (mechanism.rubs()) {
    mechanism.recover(state, vehicle.Q, pdd);
    for (int i = 0; i < state.friction.force.size(); ++i) r_ -= state.friction.force[i] * state.friction.A.col(i);
  }
  R_.resize(mechanism.freedom());
  state.dependent_block.project(r_, R_);
  yield.residual = R_.size() > 0 ? R_.lpNorm<Eigen::Infinity>() / vehicle.scale : 0.0;
  return !state.friction.jammed;
}

// Nothing is kept where bodies touch each other: their contacts turn with them.
bool MultibodyDynamics::serves(const MovingVehicle& vehicle, const StageShifts& shifts, bool curved) const {
  return !shifts.statics() && !vehicle.mechanism.rubs() && vehicle.contacts.empty() &&
         partition_version_ == vehicle.state.partition_version && (curved_ || !curved) &&
         same(shifts_.rate, shifts.rate) && same(shifts_.acceleration, shifts.acceleration);
}

void MultibodyDynamics::find_J(MovingVehicle& vehicle, const StageShifts& shifts, bool curved) {
  multibody::MechanismState& state = vehicle.state;
  const multibody::Mechanism& mechanism = vehicle.mechanism;
  const int f = mechanism.freedom();
  if (mechanism.rubs())
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
  if (mechanism.rubs()) {  // whose slope changes too much to be kept
    J_.noalias() = projector_.transpose() * NB_;
  } else {
    for (int j = 0; j < f; ++j) state.dependent_block.project(NB_.col(j), J_.col(j));
  }
}

void MultibodyDynamics::renew(MovingVehicle& vehicle, const StageShifts& shifts, bool curved, ContactRows rows,
                              VehicleYield& yield) {
  const multibody::MechanismState& state = vehicle.state;
  const int f = vehicle.mechanism.freedom();
  const auto r = static_cast<int>(rows.size());
  const bool rubs = vehicle.mechanism.rubs(), constrained = vehicle.mechanism.constraints() > 0;
  find_J(vehicle, shifts, (curved || rubs) && constrained);
  curved_ = curved || rubs || !constrained;
  shifts_ = shifts;
  partition_version_ = state.partition_version;

  multiply_directions(rows, state.columns, state.B, G_);
  if (rubs) {
    everything_.assign(state.columns.size(), {0, f});
    multiply_directions(rows, everything_, projector_, projected_);
  }
  range_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Contact& c = *rows[i].contact;
    range_[i] = state.columns[c.body];
    if (c.other_body == multibody::ground) continue;
    const multibody::ColumnRange other = state.columns[c.other_body];
    range_[i] = {std::min(range_[i].first, other.first), std::max(range_[i].last, other.last)};
  }
  const RowMatrix& left = rubs ? projected_ : G_;
  if (yield.D.size() > 0) add_contacts(left, yield.D);
  inverse_.compute(J_, shifts.statics());
  Y_.resize(f, r);
  for (int i = 0; i < r; ++i) {
    s_ = left.row(i).transpose();
    inverse_.apply(s_, dx_);
    Y_.col(i) = dx_;
  }
  yield.H.resize(r, r);
  yield.c.resize(r);
  for (int i = 0; i < r; ++i) {
    const auto [first, last] = range_[i];
    yield.H.row(i).noalias() = G_.row(i).segment(first, last - first) * Y_.middleRows(first, last - first);
  }
}

// J += G^T D G. A column of D by the row before belongs to a tangential row.
void MultibodyDynamics::add_contacts(const RowMatrix& left, const RowTangent& D) {
  DG_.resize(G_.rows(), G_.cols());
  for (int i = 0; i < G_.rows(); ++i) {
    DG_.row(i) = D(i, 1) * G_.row(i);
    if (D(i, 0) != 0.0) DG_.row(i) += D(i, 0) * G_.row(i - 1);
  }
  J_.noalias() += left.transpose() * DG_;
}

void MultibodyDynamics::go_by_itself(VehicleYield& yield) {
  inverse_.apply(R_, dx_);
  dx_ = -dx_;
  for (int i = 0; i < yield.c.size(); ++i) {
    const auto [first, last] = range_[i];
    yield.c[i] = G_.row(i).segment(first, last - first).dot(dx_.segment(first, last - first));
  }
}

const Eigen::VectorXd& MultibodyDynamics::take(const Eigen::VectorXd& forces) {
  for (int i = 0; i < forces.size(); ++i) dx_ -= forces[i] * Y_.col(i);
  return dx_;
}

}  // namespace traverse::train
