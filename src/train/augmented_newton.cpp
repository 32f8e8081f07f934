// Contact directions and residuals as right-hand sides of the augmented equations of a mechanism.
#include "augmented_newton.hpp"

#include <algorithm>

#include "train/fleet.hpp"

namespace traverse::train {
namespace {

// 1/s2: in statics springs tie all masses, because coordinates such as the rotation of a roller may have no stiffness.
// Newton's method loses a part of 1e-4 s2 times the square of a frequency, no accuracy.
constexpr double static_tie = 1e-4;

double dot3(const std::array<double, 3>& a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::array<double, 3> array3(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace

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
