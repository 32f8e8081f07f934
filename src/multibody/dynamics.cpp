// Velocities, forces and accelerations in a partition: q' = B p' + b, q'' = B p'' + d,
// B^T N B p'' = B^T (g + Q - N d), Phi_u^T lambda = (g + Q - N q'')_u   (eq. 42 projected; Wehage & Haug 1982).
#include <algorithm>
#include <cmath>

#include "multibody/mechanism.hpp"
#include "traverse/base/error.hpp"

namespace traverse::multibody {

namespace {
constexpr double interpolation_distance =
    0.02;  // scale of the interpolation's distances from a nearly singular position, relative to the mechanism's size
}  // namespace

void Mechanism::set_velocities(MechanismState& s, double t, const double* pd) const {
  prepare_workspaces(s);
  s.time = t;
  factor(s);
  if (!s.dependent_block.nearly_singular() || !interpolate_velocities(s, t, pd)) velocities_at(s, t, pd);
}

void Mechanism::compute_B(MechanismState& s) const {
  if (s.dependent_block.has_sensitivity()) return;
  s.dependent_block.compute_sensitivity();
  s.dependent_block.scatter(s.B);
}

/// Computes B, b, q' and d; Phi_q must be factorised.
void Mechanism::velocities_at(MechanismState& s, double t, const double* pd) const {
  if (!s.sensitivity_current) {
    s.mass_factored = false;
    if (!s.dependent_block.many_sensitivities()) compute_B(s);
    s.sensitivity_current = true;
  }
  s.velocities_set = true;
  for (std::size_t k = 0; k < model_.drivers.size(); ++k) {
    s.Phi_t[driver_row(static_cast<int>(k))] = -model_.drivers[k].value.rate(t);
  }
  s.dependent_block.solve(s.Phi_t, s.b);
  for (const int i : partition_.dependent) s.b[i] = -s.b[i];
  s.qd = s.b;
  s.dependent_block.expand(pd, s.qd);
  move_frames(s);
  compute_gamma(s);
  s.dependent_block.solve(s.gamma, s.d);
}

/// Computes B, b, q' and d near a singular position, such as a flat four-bar linkage or a parallelogram at a dead
/// point. The rounding error of q grows by 1/sigma in B and by 1/sigma^3 in d there, with the smallest singular value
/// sigma of Phi_u. On one branch of the motion these quantities are smooth. They are therefore interpolated from four
/// instants around the position, at a sufficient distance, with the velocities of the last accepted instant. Returns
/// false if one of the instants cannot be reached.
bool Mechanism::interpolate_velocities(MechanismState& s, double t, const double* pd) const {
  const int f = freedom();
  if (s.accepted.partition_version != partition_version_) return false;
  const double speed = s.accepted.qd.cwiseQuotient(scaling_.column).lpNorm<Eigen::Infinity>();
  if (!(speed > 0.0)) return false;
  constexpr double place[] = {-3.0, -1.0, 1.0, 3.0};
  constexpr double weight[] = {-1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0};
  s.centre = s.q;
  s.interpolated.setZero(coordinates(), f + 2);
  bool reached = true;
  for (int i = 0; i < 4 && reached; ++i) {
    const double offset = place[i] * interpolation_distance * length_ / speed;
    s.q = s.centre + offset * s.accepted.qd;
    for (int k = 0; k < f; ++k) s.change[k] = offset * (pd[k] - s.accepted.qd[partition_.independent[k]]);
    add_sensitivity(s);
    reached = solve_dependent(s, t + offset);
    if (!reached) break;
    factor(s);
    velocities_at(s, t + offset, pd);
    compute_B(s);
    s.interpolated.leftCols(f) += weight[i] * s.B;
    s.interpolated.col(f) += weight[i] * s.b;
    s.interpolated.col(f + 1) += weight[i] * s.d;
  }
  s.q = s.centre;
  s.time = t;
  place_frames(s);
  compute_Phi(s);
  factor(s);
  if (!reached) return false;
  s.factors_current = s.sensitivity_current = false;
  s.dependent_block.set_sensitivity(s.interpolated.leftCols(f));
  s.dependent_block.scatter(s.B);
  s.mass_factored = false;
  s.velocities_set = true;
  s.b = s.interpolated.col(f);
  s.d = s.interpolated.col(f + 1);
  s.qd = s.b;
  s.dependent_block.expand(pd, s.qd);
  move_frames(s);
  compute_gamma(s);
  return true;
}

void Mechanism::shift(MechanismState& s, const double* change, double rate) const {
  s.work.setZero();
  s.dependent_block.expand(change, s.work);
  s.q += s.work;
  s.qd += rate * s.work;
  place_frames(s);
  move_frames(s);
  compute_forces(s);
}

double Mechanism::effective_mass(MechanismState& s, const Eigen::VectorXd& direction) const {
  factor_mass(s);
  s.dependent_block.project(direction, s.reduced);
  s.change = s.reduced;
  solve_mass(s);
  return 1.0 / s.change.dot(s.reduced);
}

void Mechanism::accept(MechanismState& s) const {
  if (partition_.rows.empty()) return;
  Instant& a = s.accepted;
  a.time = s.time;
  a.partition_version = partition_version_;
  a.q = s.q;
  a.qd = s.qd;
  a.qdd = s.qdd;
  if (!s.dependent_block.many_sensitivities()) s.dependent_block.copy_sensitivity(a.sensitivity);
}

/// Adds the change s.change of the independent coordinates from the accepted instant, and its effect, to s.q. Where
/// there are many sensitivities, those of the last factorisation are good enough for this prediction.
void Mechanism::add_sensitivity(MechanismState& s) const {
  if (!s.dependent_block.many_sensitivities()) {
    s.accepted.sensitivity.add(s.change, partition_.independent, s.q);
    return;
  }
  s.work = s.q;
  s.dependent_block.expand(s.change.data(), s.q);
  for (const int i : partition_.independent) s.q[i] += s.work[i];
}

double Mechanism::partition_quality(MechanismState& s) const {
  const double largest =
      s.dependent_block.many_sensitivities() ? probed_sensitivity(s) : s.dependent_block.largest_sensitivity(scaling_);
  return largest > 1.0 ? 1.0 / largest : 1.0;
}

/// The largest scaled change of a dependent coordinate under two changes of all independent coordinates that are random
/// in sign, over the square root of their number: of the size of the sensitivities, without computing them.
double Mechanism::probed_sensitivity(MechanismState& s) const {
  double largest = 0.0;
  for (const double probe : {1.0, 2.0}) {
    for (int k = 0; k < freedom(); ++k)
      s.change[k] = std::copysign(scaling_.column[partition_.independent[k]], std::cos(probe * k * k + 1.0));
    s.projected.setZero(coordinates());
    s.dependent_block.expand(s.change.data(), s.projected);
    for (const int i : partition_.dependent) largest = std::max(largest, std::abs(s.projected[i]) / scaling_.column[i]);
  }
  return largest / std::sqrt(static_cast<double>(freedom()));
}

/// B^T N B is factorised itself, or by the augmented system with K = N.
void Mechanism::factor_mass(MechanismState& s) const {
  if (s.mass_factored) return;
  if (!s.dependent_block.many_sensitivities()) {
    s.reduced_mass.factor(s.dependent_block, mass_);
  } else {
    assemble_augmented(s, 1.0, 0.0, 0.0, 0.0, s.augmented_mass);
    if (!s.augmented_mass.factor())
      throw SolverError("vehicle '" + model_.name + "': its constraints are singular at t = " + std::to_string(s.time) +
                        " s");
  }
  s.mass_factored = true;
}

/// s.reduced = (B^T N B)^-1 s.reduced.
void Mechanism::solve_mass(MechanismState& s) const {
  if (!s.dependent_block.many_sensitivities()) {
    s.reduced_mass.solve(s.reduced);
    return;
  }
  s.projected.setZero(coordinates());
  for (int k = 0; k < freedom(); ++k) s.projected[partition_.independent[k]] = s.reduced[k];
  s.augmented_mass.solve(s.projected);
  for (int k = 0; k < freedom(); ++k) s.reduced[k] = s.projected[partition_.independent[k]];
}

void Mechanism::accelerations(MechanismState& s, const Eigen::VectorXd& Q, double* pdd) const {
  factor_mass(s);
  s.work = s.g + Q - mass_.cwiseProduct(s.d);
  if (has_friction()) {
    friction_in_motion(s);
    if (s.friction.jammed) throw SolverError(describe_jam(s) + " (at t = " + std::to_string(s.time) + " s)");
  }
  s.dependent_block.project(s.work, s.reduced);
  solve_mass(s);
  for (int k = 0; k < freedom(); ++k) pdd[k] = s.reduced[k];
  expand_accelerations(s, pdd);
  s.work = s.g + Q - mass_.cwiseProduct(s.qdd);
  if (has_friction()) add_friction(s);
  s.dependent_block.solve_transposed(s.work, s.lambda);
}

void Mechanism::recover(MechanismState& s, const Eigen::VectorXd& Q, const double* pdd) const {
  expand_accelerations(s, pdd);
  s.work = s.g + Q - mass_.cwiseProduct(s.qdd);
  if (has_friction()) friction_in_given_motion(s);
  s.dependent_block.solve_transposed(s.work, s.lambda);
}

/// Computes q'' from p''.
void Mechanism::expand_accelerations(MechanismState& s, const double* pdd) const {
  s.qdd = s.d;
  s.dependent_block.expand(pdd, s.qdd);
}

}  // namespace traverse::multibody
