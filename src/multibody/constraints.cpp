// Phi, Phi_q and gamma of a mechanism, and Newton's method for the dependent coordinates.
#include <algorithm>
#include <cmath>
#include <limits>

#include "multibody/mechanism.hpp"

namespace traverse::multibody {

namespace {

constexpr int max_iterations = 40;
constexpr double max_rotation = 0.5;  // rad, in one Newton step
constexpr double poor_contraction =
    0.1;  // ratio of residuals in one Newton step: a larger ratio requires a new factorisation
constexpr double dropped_tolerance = 1e-6;  // tolerance of dropped rows, relative to the mechanism's size

}  // namespace

void Mechanism::place_frames(MechanismState& s) const {
  for (std::size_t i = 1; i < s.frames.size(); ++i) {
    Frame& frame = s.frames[i];
    const double* q = s.q.data() + 3 * (i - 1);
    frame.origin = {q[0], q[1]};
    if (q[2] != frame.angle) frame.set_angle(q[2]);
  }
}

void Mechanism::move_frames(MechanismState& s) const {
  for (std::size_t i = 1; i < s.frames.size(); ++i) {
    const double* qd = s.qd.data() + 3 * (i - 1);
    s.frames[i].velocity = {qd[0], qd[1]};
    s.frames[i].omega = qd[2];
  }
}

void Mechanism::compute_Phi(MechanismState& s) const {
  for (const JointGeometry& joint : joints_) {
    joint_residual(joint, frame(s, joint.first), frame(s, joint.second), s.Phi.data() + joint.row);
  }
  for (std::size_t k = 0; k < model_.drivers.size(); ++k) {
    const Driver& driver = model_.drivers[k];
    s.Phi[driver_row(static_cast<int>(k))] = s.q[3 * driver.body + driver.coordinate] - driver.value.value(s.time);
  }
}

/// Computes Phi_q and records whether it has changed: a mechanism that does not rotate keeps its factors.
void Mechanism::compute_Phi_q(MechanismState& s) const {
  JointJacobian rows;
  bool same = true;
  const auto set = [&](int row, int column, double value) {
    same = same && s.Phi_q(row, column) == value;
    s.Phi_q(row, column) = value;
  };
  for (const JointGeometry& joint : joints_) {
    joint_jacobian(joint, frame(s, joint.first), frame(s, joint.second), rows);
    const int count = joint.type->rows;
    for (int end = 0; end < 2; ++end) {
      const int body = end == 0 ? joint.first : joint.second;
      if (body == ground) continue;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < count; ++r) set(joint.row + r, 3 * body + c, rows(r, 3 * end + c));
    }
  }
  for (std::size_t k = 0; k < model_.drivers.size(); ++k) {
    const Driver& driver = model_.drivers[k];
    set(driver_row(static_cast<int>(k)), 3 * driver.body + driver.coordinate, 1.0);
  }
  if (!same) s.factors_current = s.sensitivity_current = false;
}

void Mechanism::compute_gamma(MechanismState& s) const {
  for (const JointGeometry& joint : joints_) {
    joint_gamma(joint, frame(s, joint.first), frame(s, joint.second), s.gamma.data() + joint.row);
  }
  for (std::size_t k = 0; k < model_.drivers.size(); ++k) {
    s.gamma[driver_row(static_cast<int>(k))] = model_.drivers[k].value.acceleration(s.time);
  }
}

/// Predicts the dependent coordinates at p: at a new time by Taylor's series from the last accepted instant, at the
/// same time by the sensitivity at the last velocities. Near a singular position, where branches intersect, the
/// prediction determines which branch Newton's method finds.
void Mechanism::predict(MechanismState& s, double t, const double* p) const {
  const int f = freedom();
  const Instant& a = s.accepted;
  if (t != s.time && a.partition_version == partition_version_) {
    const double dt = t - a.time;
    s.q = a.q + dt * (a.qd + 0.5 * dt * a.qdd);
    for (int k = 0; k < f; ++k) s.change[k] = p[k] - s.q[partition_.independent[k]];
    add_sensitivity(s);
  } else if (s.velocities_set) {
    for (int k = 0; k < f; ++k) s.change[k] = p[k] - s.q[partition_.independent[k]];
    s.dependent_block.expand(s.change.data(), s.q);
  }
  for (int k = 0; k < f; ++k) s.q[partition_.independent[k]] = p[k];
}

/// Sets the sizes of the workspaces and the order of elimination for the mechanism's partition.
void Mechanism::prepare_workspaces(MechanismState& s) const {
  if (s.partition_version == partition_version_) return;
  const int f = freedom();
  s.B.setZero(coordinates(), f);
  for (int k = 0; k < f; ++k) s.B(partition_.independent[k], k) = 1.0;
  s.b.setZero();
  s.d.setZero();
  s.lambda.setZero();
  s.reduced.setZero(f);
  s.change.setZero(f);
  place_frames(s);
  compute_Phi_q(s);
  plan_elimination(s);
  s.partition_version = partition_version_;
  s.factored = false;
  s.velocities_set = false;
  s.mass_factored = false;
  s.factors_current = s.sensitivity_current = false;
}

/// Chooses the orders of elimination at the present Phi_q.
void Mechanism::plan_elimination(MechanismState& s) const {
  s.dependent_block.plan(s.Phi_q, pattern_, partition_, scaling_);
  if (!s.dependent_block.many_sensitivities())
    s.reduced_mass.plan(s.dependent_block);
  else
    s.augmented_mass.plan(augmented_pattern());
  find_columns(s);
}

void Mechanism::find_columns(MechanismState& s) const {
  s.columns.assign(model_.bodies.size(), {freedom(), 0});
  const auto extend = [&](int coordinate, int k) {
    ColumnRange& range = s.columns[coordinate / 3];
    range.first = std::min(range.first, k);
    range.last = std::max(range.last, k + 1);
  };
  for (int k = 0; k < freedom(); ++k) extend(partition_.independent[k], k);
  const DependentBlock& block = s.dependent_block;
  for (int i = 0; i < block.size(); ++i)
    for (const int* k = block.sensitivity_begin(i); k != block.sensitivity_end(i); ++k) extend(block.coordinate(i), *k);
  for (ColumnRange& range : s.columns) range.first = std::min(range.first, range.last);
}

/// Factorises the dependent block at the current frames, with a new order if the old order has become inaccurate.
void Mechanism::factor(MechanismState& s) const {
  compute_Phi_q(s);
  if (s.factors_current) return;
  s.sensitivity_current = false;
  if (!s.dependent_block.factor(s.Phi_q)) {
    s.velocities_set = false;
    plan_elimination(s);
    s.B.setZero();
    for (int k = 0; k < freedom(); ++k) s.B(partition_.independent[k], k) = 1.0;
  }
  s.factored = s.factors_current = true;
}

/// The largest residual of the kept equations, m.
double Mechanism::kept_residual(const MechanismState& s) const {
  double largest = 0.0;
  for (const int row : partition_.rows) {
    const double size = std::abs(s.Phi[row]) * scaling_.row[row];
    if (!(size <= largest)) largest = size;  // also for NaN
  }
  return largest;
}

/// One Newton step on the dependent coordinates with the present factorisation. Returns false if it is not finite.
bool Mechanism::correct_dependent(MechanismState& s) const {
  ++s.corrections;
  s.dependent_block.solve(s.Phi, s.work);
  double rotation = 0.0;
  bool finite = true;
  for (const int i : partition_.dependent) {
    finite = finite && std::isfinite(s.work[i]);
    if (i % 3 == 2) rotation = std::max(rotation, std::abs(s.work[i]));
  }
  if (!finite) return false;
  const double part = rotation > max_rotation ? max_rotation / rotation : 1.0;
  for (const int i : partition_.dependent) s.q[i] -= part * s.work[i];
  return true;
}

/// Newton's method on the kept rows from s.q. The last factorisation is used while the residual decreases fast enough.
bool Mechanism::solve_dependent(MechanismState& s, double t) const {
  s.time = t;
  place_frames(s);
  compute_Phi(s);
  if (partition_.rows.empty()) return true;
  const double largest = s.q.cwiseAbs().maxCoeff();
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * (length_ + largest);
  double before = std::numeric_limits<double>::infinity();
  bool fresh = false;
  for (int i = 0; i < max_iterations; ++i) {
    const double residual = kept_residual(s);
    if (!std::isfinite(residual)) return false;
    if (residual <= rounding) return true;
    const bool poor = residual > poor_contraction * before;
    if (poor && fresh && residual <= 100.0 * rounding) return true;  // limited by rounding
    if (!s.factored || s.dependent_block.nearly_singular() || (poor && i > 0)) {
      factor(s);
      fresh = true;
    } else {
      fresh = false;
    }
    if (!correct_dependent(s)) return false;
    before = residual;
    place_frames(s);
    compute_Phi(s);
  }
  return false;
}

bool Mechanism::set_positions(MechanismState& s, double t, const double* p) const {
  prepare_workspaces(s);
  predict(s, t, p);
  if (!solve_dependent(s, t)) return false;
  if (static_cast<int>(partition_.rows.size()) == constraints()) return true;
  for (int row = 0; row < constraints(); ++row) {
    if (!(std::abs(s.Phi[row]) * scaling_.row[row] <= dropped_tolerance * length_)) return false;
  }
  return true;
}

}  // namespace traverse::multibody
