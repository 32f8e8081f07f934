// phi2 + ratio phi1 - angle = 0: two bodies rotate together. The ratio is the radius of the first over the radius of
// the second body. If it is positive, they rotate in opposite directions like meshing wheels; if it is negative, in the
// same direction like wheels with a belt. 1 equation, rad; lambda is a moment. Their bearings carry the forces.
#pragma once

#include "multibody/joint.hpp"

namespace traverse::multibody::equations {

struct Gear {
  static constexpr int rows = 1;
  static constexpr bool angle = true;
  static constexpr JointNeeds needs{};
  static constexpr JointNumber numbers[] = {
      {"ratio", "1", "radius of the first body's wheel over that of the second's; below 0: a belt, they turn alike"}};

  static void prepare(const Joint& joint, const Frame& first, const Frame& second, JointGeometry& j) {
    j.angle = second.angle + joint.numbers[0] * first.angle;
  }

  static void residual(const JointGeometry& j, const Frame& first, const Frame& second, double* Phi) {
    Phi[0] = second.angle + j.numbers[0] * first.angle - j.angle;
  }

  static void gradient(const JointGeometry& j, const Frame&, const Frame&, int row, JointJacobian& Phi_q) {
    Phi_q.row(row) << 0.0, 0.0, j.numbers[0], 0.0, 0.0, 1.0;
  }

  static void gamma(const JointGeometry&, const Frame&, const Frame&, double* gamma) { gamma[0] = 0.0; }

  static void curvature(const JointGeometry&, const Frame&, const Frame&, const double*, JointCurvature&) {}

  static Eigen::Vector3d reaction(const JointGeometry&, const Frame&, const Frame&, const double* lambda) {
    return {0.0, 0.0, -lambda[0]};
  }
};

}  // namespace traverse::multibody::equations
