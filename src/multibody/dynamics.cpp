// Velocities, forces and accelerations in a partition: q' = B p' + b, q'' = B p'' + d,
// B^T N B p'' = B^T (g + Q - N d), Phi_u^T lambda = (g + Q - N q'')_u   (eq. 42 projected; Wehage & Haug 1982).
#include "traverse/multibody/mechanism.hpp"

namespace traverse::multibody {

void Mechanism::set_velocities(MechanismState& s, double t, const double* pd) const {
  fit(s);
  s.time = t;
  factor(s);
  s.mass_factored = false;
  s.dependent_block.compute_sensitivity();
  s.dependent_block.scatter(s.B);
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

double Mechanism::partition_quality(const MechanismState& s) const {
  const double largest = s.dependent_block.largest_sensitivity(scaling_);
  return largest > 1.0 ? 1.0 / largest : 1.0;
}

void Mechanism::accelerations(MechanismState& s, const Eigen::VectorXd& Q, double* pdd) const {
  if (!s.mass_factored) s.reduced_mass.factor(s.dependent_block, mass_);
  s.mass_factored = true;
  s.work = s.g + Q - mass_.cwiseProduct(s.d);
  s.dependent_block.project(s.work, s.reduced);
  s.reduced_mass.solve(s.reduced);
  for (int k = 0; k < freedom(); ++k) pdd[k] = s.reduced[k];
  recover(s, Q, pdd);
}

void Mechanism::recover(MechanismState& s, const Eigen::VectorXd& Q, const double* pdd) const {
  s.qdd = s.d;
  s.dependent_block.expand(pdd, s.qdd);
  s.work = s.g + Q - mass_.cwiseProduct(s.qdd);
  s.dependent_block.solve_transposed(s.work, s.lambda);
}

void Mechanism::compute_lambda_curvature(MechanismState& s) const {
  s.lambda_curvature.setZero();
  JointCurvature K;
  for (const JointGeometry& joint : joints_) {
    joint_curvature(joint, frame(s, joint.first), frame(s, joint.second), s.lambda.data() + joint.row, K);
    add_pair(joint.first, joint.second, K, s.lambda_curvature);
  }
}

}  // namespace traverse::multibody
