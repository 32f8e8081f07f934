// P2 - P1 = 0: two bodies share a point. 2 equations, m.
#pragma once

#include "multibody/joint.hpp"

namespace traverse::multibody::equations {

/// Arms and the vector between the joint's points, in global components.
struct Placement {
  Eigen::Vector2d a1, a2;  // arms
  Eigen::Vector2d d;       // P2 - P1
  Placement(const JointGeometry& j, const Frame& first, const Frame& second)
      : a1(first.to_global(j.first_arm)),
        a2(second.to_global(j.second_arm)),
        d((second.origin - first.origin) + (a2 - a1)) {}
};

struct Point {
  static constexpr int rows = 2;
  static constexpr bool angle = false;
  static constexpr JointNeeds needs{.point = true};

  static void prepare(const Joint&, const Frame&, const Frame&, JointGeometry&) {}

  static void residual(const JointGeometry& j, const Frame& first, const Frame& second, double* Phi) {
    const Placement p(j, first, second);
    Phi[0] = p.d.x();
    Phi[1] = p.d.y();
  }

  static void gradient(const JointGeometry& j, const Frame& first, const Frame& second, int row, JointJacobian& Phi_q) {
    const Eigen::Vector2d t1 = quarter_turn(first.to_global(j.first_arm));
    const Eigen::Vector2d t2 = quarter_turn(second.to_global(j.second_arm));
    Phi_q.row(row) << -1.0, 0.0, -t1.x(), 1.0, 0.0, t2.x();
    Phi_q.row(row + 1) << 0.0, -1.0, -t1.y(), 0.0, 1.0, t2.y();
  }

  static Eigen::Vector2d gamma(const JointGeometry& j, const Frame& first, const Frame& second) {
    return second.omega * second.omega * second.to_global(j.second_arm) -
           first.omega * first.omega * first.to_global(j.first_arm);
  }
  static void gamma(const JointGeometry& j, const Frame& first, const Frame& second, double* gamma_of_rows) {
    const Eigen::Vector2d value = gamma(j, first, second);
    gamma_of_rows[0] = value.x();
    gamma_of_rows[1] = value.y();
  }

  static void curvature(const JointGeometry& j, const Frame& first, const Frame& second, const double* lambda,
                        JointCurvature& K) {
    const Eigen::Vector2d force(lambda[0], lambda[1]);
    K(2, 2) += force.dot(first.to_global(j.first_arm));
    K(5, 5) -= force.dot(second.to_global(j.second_arm));
  }

  static Eigen::Vector3d reaction(const JointGeometry&, const Frame&, const Frame&, const double* lambda) {
    return {-lambda[0], -lambda[1], 0.0};
  }
};

}  // namespace traverse::multibody::equations
