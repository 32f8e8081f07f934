// Dry friction in sliding joints, whose normal forces depend on the accelerations and thus on the friction itself.
//
// The friction along the axis of joint k is f_k = -(mu_k |lambda_k| + F_k) tanh(v_k/v0_k). lambda is linear in f,
// lambda = lambda_0 + G f, both for accelerations that follow from the forces and for given accelerations (G differs).
// With assumed signs of the lambda_k this is a small linear system. The correct signs are found by repeated solution
// (Newton's method for a piecewise linear function, which ends after finitely many steps). If friction exceeds its
// cause, G_kk mu_k >= 1, a joint jams: there is no solution or more than one (Painleve's paradox).
#include <cmath>

#include "multibody/mechanism.hpp"

namespace traverse::multibody {

namespace {
constexpr int max_trials = 30;            // number of trial solutions
constexpr double min_determinant = 1e-6;  // determinant of the system for lambda; without friction it is 1

}  // namespace

/// Computes the quantities of friction that depend on positions and velocities only.
void Mechanism::compute_friction_kinematics(MechanismState& s) const {
  FrictionState& r = s.friction;
  for (std::size_t i = 0; i < friction_joints_.size(); ++i) {
    const int k = static_cast<int>(i);
    const JointGeometry& joint = joints_[friction_joints_[i]];
    const PairForce gradient = slide_gradient(joint, frame(s, joint.first), frame(s, joint.second));
    if (joint.first != ground) r.A.col(k).segment<3>(3 * joint.first) = gradient.head<3>();
    if (joint.second != ground) r.A.col(k).segment<3>(3 * joint.second) = gradient.tail<3>();
    r.speed[k] = r.A.col(k).dot(s.qd);
    r.share[k] = std::tanh(r.speed[k] / joint.friction.transition_speed);
    if (joint.friction.coefficient == 0.0) continue;
    r.unit[joint.row] = 1.0;
    r.work.setZero();
    s.dependent_block.solve(r.unit, r.work);
    r.unit[joint.row] = 0.0;
    r.H.col(k) = r.work;
  }
}

/// Sets r.force to the friction that is independent of normal forces and adds it to s.work.
void Mechanism::add_constant_friction(MechanismState& s) const {
  FrictionState& r = s.friction;
  r.jammed = false;
  for (int k = 0; k < r.force.size(); ++k) r.force[k] = -joints_[friction_joints_[k]].friction.force * r.share[k];
  add_friction(s);
}

void Mechanism::add_friction(MechanismState& s) const {
  const FrictionState& r = s.friction;
  for (int k = 0; k < r.force.size(); ++k) s.work += r.force[k] * r.A.col(k);
}

/// Solves lambda = start - gain diag(mu share) |lambda|. The signs of the last lambda are tried first.
void Mechanism::solve_normal_forces(MechanismState& s) const {
  FrictionState& r = s.friction;
  const auto count = static_cast<int>(friction_joints_.size());
  const auto slope = [&](int k) { return joints_[friction_joints_[k]].friction.coefficient * r.share[k]; };
  for (int k = 0; k < count; ++k)
    if (std::abs(r.gain(k, k) * slope(k)) >= 1.0) r.jammed = true;
  for (int i = 0; i < max_trials; ++i) {
    for (int k = 0; k < count; ++k) r.by_lambda[k] = std::signbit(r.normal_force[k]) ? -slope(k) : slope(k);
    for (int k = 0; k < count; ++k) r.system.col(k) = r.by_lambda[k] * r.gain.col(k);
    r.system.diagonal().array() += 1.0;
    r.lu.compute(r.system);
    r.system.setIdentity();
    r.inverse = r.lu.solve(r.system);  // lu.inverse() would allocate memory
    bool same = true;
    for (int k = 0; k < count; ++k) {
      const double lambda = r.inverse.row(k).dot(r.start);
      same = same && (slope(k) == 0.0 || lambda == 0.0 || std::signbit(lambda) == std::signbit(r.normal_force[k]));
      r.normal_force[k] = lambda;
    }
    if (!same) continue;
    if (!(r.lu.determinant() > min_determinant)) r.jammed = true;
    return;
  }
  r.jammed = true;
}

/// Adds the friction due to the known normal forces to r.force and s.work.
void Mechanism::add_normal_friction(MechanismState& s) const {
  FrictionState& r = s.friction;
  for (int k = 0; k < r.force.size(); ++k) {
    const double force = -r.by_lambda[k] * r.normal_force[k];
    r.force[k] += force;
    s.work += force * r.A.col(k);
  }
}

/// r.work = force - N q'' for the motion that follows from the force alone. The reduced mass must be factorised.
void Mechanism::compute_response(MechanismState& s, const Eigen::Ref<const Eigen::VectorXd>& force) const {
  FrictionState& r = s.friction;
  s.dependent_block.project(force, s.reduced);
  solve_mass(s);
  r.work.setZero();
  s.dependent_block.expand(s.reduced.data(), r.work);
  r.work = force - mass_.cwiseProduct(r.work);
}

/// s.work = g + Q - N d: adds friction to it, with unknown accelerations.
void Mechanism::friction_in_motion(MechanismState& s) const {
  FrictionState& r = s.friction;
  add_constant_friction(s);
  if (!has_normal_friction_) return;
  compute_response(s, s.work);
  for (int k = 0; k < r.start.size(); ++k) r.start[k] = r.H.col(k).dot(r.work);
  for (int k = 0; k < r.start.size(); ++k) {
    compute_response(s, r.A.col(k));
    for (int j = 0; j < r.start.size(); ++j) r.gain(j, k) = r.H.col(j).dot(r.work);
  }
  solve_normal_forces(s);
  add_normal_friction(s);
}

/// s.work = g + Q - N q'': adds friction to it, with given accelerations.
void Mechanism::friction_in_given_motion(MechanismState& s) const {
  FrictionState& r = s.friction;
  add_constant_friction(s);
  if (!has_normal_friction_) return;
  for (int k = 0; k < r.start.size(); ++k) r.start[k] = r.H.col(k).dot(s.work);
  for (int k = 0; k < r.start.size(); ++k)
    for (int j = 0; j < r.start.size(); ++j) r.gain(j, k) = r.H.col(j).dot(r.A.col(k));
  solve_normal_forces(s);
  add_normal_friction(s);
}

// A change r of the residual at fixed lambda changes lambda by -(1 + gain by_lambda)^-1 H^T r in the joints with
// friction, and thus the friction. The projection is then B^T (r - A by_lambda (1 + gain by_lambda)^-1 H^T r).
void Mechanism::friction_projector(const MechanismState& s, Eigen::MatrixXd& projector) const {
  const FrictionState& r = s.friction;
  projector = s.B;
  if (!has_normal_friction_) return;
  for (int k = 0; k < r.start.size(); ++k) {
    if (r.by_lambda[k] == 0.0) continue;
    for (int column = 0; column < projector.cols(); ++column) {
      const double along = r.by_lambda[k] * r.A.col(k).dot(s.B.col(column));
      for (int j = 0; j < r.start.size(); ++j) projector.col(column) -= along * r.inverse(k, j) * r.H.col(j);
    }
  }
}

std::string Mechanism::describe_jam(const MechanismState& s) const {
  const FrictionState& r = s.friction;
  int worst = 0;
  const auto growth = [&](int k) {
    return std::abs(r.gain(k, k) * r.share[k]) * joints_[friction_joints_[k]].friction.coefficient;
  };
  for (int k = 1; k < r.share.size(); ++k)
    if (growth(k) > growth(worst)) worst = k;
  return "vehicle '" + model_.name + "': friction jams joint '" + model_.joints[friction_joints_[worst]].name +
         "', it causes more normal force than it needs; take a lower friction coefficient or a shorter arm";
}

void Mechanism::multiply_friction_tangent(const MechanismState& s, double by_q, double by_qd,
                                          Eigen::MatrixXd& product) const {
  const FrictionState& r = s.friction;
  JointCurvature curvature;
  for (std::size_t i = 0; i < friction_joints_.size(); ++i) {
    const int k = static_cast<int>(i);
    const JointGeometry& joint = joints_[friction_joints_[i]];
    const Frame &first = frame(s, joint.first), &second = frame(s, joint.second);
    const PairForce gradient = slide_gradient(joint, first, second);
    slide_curvature(joint, first, second, curvature);
    PairForce rate;
    rate << first.velocity, first.omega, second.velocity, second.omega;
    const double level = joint.friction.coefficient * std::abs(r.normal_force[k]) + joint.friction.force;
    const double damping = level * (1.0 - r.share[k] * r.share[k]) / joint.friction.transition_speed;
    const PairForce speed_by_q = curvature * rate;
    const PairMatrix K =
        by_q * r.force[k] * curvature - damping * gradient * (by_q * speed_by_q + by_qd * gradient).transpose();
    add_pair_times_B(joint.first, joint.second, K, s, product);
  }
}

}  // namespace traverse::multibody
