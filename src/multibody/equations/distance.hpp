// (d . d - L^2) / (2 L) = 0 with d = P2 - P1: two points keep their distance. 1 equation, m; lambda is a force.
#pragma once

#include "point.hpp"

namespace traverse::multibody::equations {

struct Distance {
  static constexpr int rows = 1;
  static constexpr bool angle = false;
  static constexpr JointNeeds needs{.ends = true};

  static void prepare(const Joint& joint, const Frame&, const Frame&, JointGeometry& j) {
    j.length = (joint.to - joint.from).norm();
  }

  static void residual(const JointGeometry& j, const Frame& first, const Frame& second, double* Phi) {
    const Placement p(j, first, second);
    Phi[0] = (p.d.squaredNorm() - j.length * j.length) / (2.0 * j.length);
  }

  static void gradient(const JointGeometry& j, const Frame& first, const Frame& second, int row, JointJacobian& Phi_q) {
    const Placement p(j, first, second);
    const Eigen::Vector2d u = p.d / j.length;
    Phi_q.row(row) << -u.x(), -u.y(), -u.dot(quarter_turn(p.a1)), u.x(), u.y(), u.dot(quarter_turn(p.a2));
  }

  static void gamma(const JointGeometry& j, const Frame& first, const Frame& second, double* gamma) {
    const Placement p(j, first, second);
    const Eigen::Vector2d rate = second.velocity_at(p.a2) - first.velocity_at(p.a1);
    gamma[0] = (p.d.dot(Point::gamma(j, first, second)) - rate.squaredNorm()) / j.length;
  }

  static void curvature(const JointGeometry& j, const Frame& first, const Frame& second, const double* lambda,
                        JointCurvature& K) {
    const Placement p(j, first, second);
    Eigen::Matrix<double, 2, 6> d_q;
    d_q << -Eigen::Matrix2d::Identity(), -quarter_turn(p.a1), Eigen::Matrix2d::Identity(), quarter_turn(p.a2);
    const double force_per_length = lambda[0] / j.length;
    K.noalias() += force_per_length * d_q.transpose() * d_q;
    const Eigen::Vector2d force = force_per_length * p.d;
    Point::curvature(j, first, second, force.data(), K);
  }

  static Eigen::Vector3d reaction(const JointGeometry& j, const Frame& first, const Frame& second,
                                  const double* lambda) {
    const Eigen::Vector2d force = -lambda[0] / j.length * Placement(j, first, second).d;
    return {force.x(), force.y(), 0.0};
  }
};

}  // namespace traverse::multibody::equations
