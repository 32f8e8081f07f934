// phi2 - phi1 - angle = 0: two bodies rotate by the same angle. 1 equation, rad; lambda is a moment.
#pragma once

#include "multibody/joint.hpp"

namespace traverse::multibody::equations {

struct Angle {
  static constexpr int rows = 1;
  static constexpr bool angle = true;
  static constexpr JointNeeds needs{};

  static void prepare(const Joint&, const Frame& first, const Frame& second, JointGeometry& j) {
    j.angle = second.angle - first.angle;
  }

  static void residual(const JointGeometry& j, const Frame& first, const Frame& second, double* Phi) {
    Phi[0] = second.angle - first.angle - j.angle;
  }

  static void gradient(const JointGeometry&, const Frame&, const Frame&, int row, JointJacobian& Phi_q) {
    Phi_q.row(row) << 0.0, 0.0, -1.0, 0.0, 0.0, 1.0;
  }

  static void gamma(const JointGeometry&, const Frame&, const Frame&, double* gamma) { gamma[0] = 0.0; }

  static void curvature(const JointGeometry&, const Frame&, const Frame&, const double*, JointCurvature&) {}

  static Eigen::Vector3d reaction(const JointGeometry&, const Frame&, const Frame&, const double* lambda) {
    return {0.0, 0.0, -lambda[0]};
  }
};

}  // namespace traverse::multibody::equations
