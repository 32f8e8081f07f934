// Constraint equations of a joint with their derivatives (eqs. 42-44 of the paper).
//
// A joint consists of one or more kinds of equations between a first and a second body. Each kind has a separate file:
//   point     P2 - P1 = 0                   2 equations, m                                  equations/point.hpp
//   normal    n . (P2 - r1) - offset = 0    1 equation, m; n is fixed in the first body,    equations/normal.hpp
//                                           r1 its centre of mass
//   distance  (d.d - L^2) / (2 L) = 0       1 equation, m; d = P2 - P1,                     equations/distance.hpp
//                                           so that lambda is a force
//   angle     phi2 - phi1 - angle = 0       1 equation, rad                                 equations/angle.hpp
//   gear      phi2 + ratio phi1 - angle = 0 1 equation, rad                                 equations/gear.hpp
// Each kind defines its number of rows, whether they are angles, the members of Joint that it needs (JointNeeds), and
// the functions prepare, residual, gradient, gamma, curvature and reaction, which the functions below combine.
// joint_types.cpp contains the table of joint types. With N q'' + Phi_q^T lambda = g, the joint acts on the second body
// with -lambda.
#pragma once

#include <Eigen/Core>

#include "traverse/multibody/frame.hpp"
#include "traverse/multibody/model.hpp"

namespace traverse::multibody {

/// A joint in body-fixed components.
struct JointGeometry {
  JointType type = JointType::revolute;
  int first = ground;
  int second = ground;
  int row = 0;                                           // first row of the joint in Phi
  Eigen::Vector2d first_arm = Eigen::Vector2d::Zero();   // m, to the joint's point, in the first body
  Eigen::Vector2d second_arm = Eigen::Vector2d::Zero();  // m, to the joint's point, in the second body
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();     // normal to the axis, in the first body
  double offset = 0.0;                                   // m, normal . first_arm
  double angle = 0.0;                                    // rad, phi2 - phi1 at t = 0
  double length = 0.0;                                   // length of a distance joint, m
  std::array<double, most_joint_numbers> numbers = {};   // additional numbers of the type
  SlidingFriction friction;
};

/// `first` and `second` are the bodies' frames at t = 0.
JointGeometry joint_geometry(const Joint& joint, const Frame& first, const Frame& second, int row);

/// Phi of the joint, one value per row of its type.
inline void joint_residual(const JointGeometry& joint, const Frame& first, const Frame& second, double* Phi) {
  joint.type->residual(joint, first, second, Phi);
}
/// Phi_q of the joint.
inline void joint_jacobian(const JointGeometry& joint, const Frame& first, const Frame& second, JointJacobian& Phi_q) {
  joint.type->jacobian(joint, first, second, Phi_q);
}
/// gamma = -(Phi_q q')_q q' of the joint (eq. 44 as corrected in doc/theory.md; joints do not depend on time).
inline void joint_gamma(const JointGeometry& joint, const Frame& first, const Frame& second, double* gamma) {
  joint.type->gamma(joint, first, second, gamma);
}
/// d(Phi_q^T lambda)/dq at fixed lambda; symmetric.
inline void joint_curvature(const JointGeometry& joint, const Frame& first, const Frame& second, const double* lambda,
                            JointCurvature& curvature) {
  joint.type->curvature(joint, first, second, lambda, curvature);
}
/// The gradient of the sliding displacement, columns x1 y1 phi1 x2 y2 phi2. The sliding displacement is the
/// displacement of the joint's point on the second body along the axis, relative to the first body. The gradient times
/// the velocities is the sliding speed. Times a force along the axis, it is the generalized force of this force on the
/// second body and its opposite on the first, both at this point.
Eigen::Matrix<double, 6, 1> slide_gradient(const JointGeometry& joint, const Frame& first, const Frame& second);
/// The derivative of slide_gradient; symmetric.
void slide_curvature(const JointGeometry& joint, const Frame& first, const Frame& second, JointCurvature& curvature);
/// Force on the second body, and moment on it about the joint's point on this body (about `to` if the joint has one).
inline Eigen::Vector3d joint_reaction(const JointGeometry& joint, const Frame& first, const Frame& second,
                                      const double* lambda) {
  return joint.type->reaction(joint, first, second, lambda);
}

}  // namespace traverse::multibody
