// n . (P2 - r1) - offset = 0: the point of the second body remains on a line of the first. 1 equation, m; n is fixed in
// the first body, r1 its centre of mass.
#pragma once

#include <cmath>

#include "multibody/joint.hpp"

namespace traverse::multibody::equations {

/// The quantities of the normal equation, also with another direction n of the first body.
struct NormalPlacement {
  Eigen::Vector2d a2, n, e;  // second arm, direction, P2 - r1
  NormalPlacement(const JointGeometry& j, const Frame& first, const Frame& second)
      : NormalPlacement(j, j.normal, first, second) {}
  NormalPlacement(const JointGeometry& j, const Eigen::Vector2d& direction, const Frame& first, const Frame& second)
      : a2(second.to_global(j.second_arm)), n(first.to_global(direction)), e(second.origin - first.origin + a2) {}
  /// The gradient of n . e.
  Eigen::Matrix<double, 1, 6> gradient() const {
    Eigen::Matrix<double, 1, 6> g;
    g << -n.x(), -n.y(), quarter_turn(n).dot(e), n.x(), n.y(), n.dot(quarter_turn(a2));
    return g;
  }
  /// Adds the second derivatives of lambda n . e.
  void add_curvature(double lambda, JointCurvature& K) const {
    const Eigen::Vector2d t = lambda * quarter_turn(n);
    const double lever = lambda * n.dot(a2);
    K.block<2, 1>(0, 2) -= t;
    K.block<1, 2>(2, 0) -= t.transpose();
    K.block<2, 1>(3, 2) += t;
    K.block<1, 2>(2, 3) += t.transpose();
    K(2, 2) -= lambda * n.dot(e);
    K(2, 5) += lever;
    K(5, 2) += lever;
    K(5, 5) -= lever;
  }
};

struct Normal {
  static constexpr int rows = 1;
  static constexpr bool angle = false;
  static constexpr JointNeeds needs{.point = true, .axis = true};

  static void prepare(const Joint& joint, const Frame& first, const Frame&, JointGeometry& j) {
    // Components in the range of rounding errors would only reduce the sparsity of Phi_q.
    Eigen::Vector2d n = -quarter_turn(joint.axis.normalized());
    for (double& component : n)
      if (std::abs(component) < 1e-15) component = 0.0;
    j.normal = first.to_body(n);
    j.offset = j.normal.dot(j.first_arm);
  }

  static void residual(const JointGeometry& j, const Frame& first, const Frame& second, double* Phi) {
    const NormalPlacement p(j, first, second);
    Phi[0] = p.n.dot(p.e) - j.offset;
  }

  static void gradient(const JointGeometry& j, const Frame& first, const Frame& second, int row, JointJacobian& Phi_q) {
    Phi_q.row(row) = NormalPlacement(j, first, second).gradient();
  }

  static void gamma(const JointGeometry& j, const Frame& first, const Frame& second, double* gamma) {
    const NormalPlacement p(j, first, second);
    const Eigen::Vector2d rate = second.velocity_at(p.a2) - first.velocity;
    gamma[0] = first.omega * first.omega * p.n.dot(p.e) - 2.0 * first.omega * quarter_turn(p.n).dot(rate) +
               second.omega * second.omega * p.n.dot(p.a2);
  }

  static void curvature(const JointGeometry& j, const Frame& first, const Frame& second, const double* lambda,
                        JointCurvature& K) {
    NormalPlacement(j, first, second).add_curvature(lambda[0], K);
  }

  static Eigen::Vector3d reaction(const JointGeometry& j, const Frame& first, const Frame&, const double* lambda) {
    const Eigen::Vector2d force = -lambda[0] * first.to_global(j.normal);
    return {force.x(), force.y(), 0.0};
  }
};

}  // namespace traverse::multibody::equations
