#include "traverse/multibody/joint.hpp"

#include <cmath>

namespace traverse::multibody {

using Eigen::Vector2d;

namespace {

/// Arms, the vector between the joint's points and the normal, in global components.
struct Placement {
  Vector2d a1, a2;  // arms
  Vector2d d;       // P2 - P1
  Placement(const JointGeometry& j, const Frame& first, const Frame& second)
      : a1(first.to_global(j.first_arm)),
        a2(second.to_global(j.second_arm)),
        d((second.origin - first.origin) + (a2 - a1)) {}
};

/// What the normal equation n . e - offset = 0 needs, and the same of another direction n of the first body.
struct NormalPlacement {
  Vector2d a2, n, e;  // second arm, direction, P2 - r1
  NormalPlacement(const JointGeometry& j, const Frame& first, const Frame& second)
      : NormalPlacement(j, j.normal, first, second) {}
  NormalPlacement(const JointGeometry& j, const Vector2d& direction, const Frame& first, const Frame& second)
      : a2(second.to_global(j.second_arm)), n(first.to_global(direction)), e(second.origin - first.origin + a2) {}
  /// Of n . e.
  Eigen::Matrix<double, 1, 6> gradient() const {
    Eigen::Matrix<double, 1, 6> g;
    g << -n.x(), -n.y(), quarter_turn(n).dot(e), n.x(), n.y(), n.dot(quarter_turn(a2));
    return g;
  }
};

void point_jacobian(const JointGeometry& j, const Frame& first, const Frame& second, JointJacobian& J) {
  const Vector2d t1 = quarter_turn(first.to_global(j.first_arm));
  const Vector2d t2 = quarter_turn(second.to_global(j.second_arm));
  J.row(0) << -1.0, 0.0, -t1.x(), 1.0, 0.0, t2.x();
  J.row(1) << 0.0, -1.0, -t1.y(), 0.0, 1.0, t2.y();
}

void normal_jacobian(const JointGeometry& j, const Frame& first, const Frame& second, JointJacobian& J) {
  J.row(0) = NormalPlacement(j, first, second).gradient();
}

void distance_jacobian(const JointGeometry& j, const Frame& first, const Frame& second, JointJacobian& J) {
  const Placement p(j, first, second);
  const Vector2d u = p.d / j.length;
  J.row(0) << -u.x(), -u.y(), -u.dot(quarter_turn(p.a1)), u.x(), u.y(), u.dot(quarter_turn(p.a2));
}

Vector2d point_gamma(const JointGeometry& j, const Frame& first, const Frame& second) {
  return second.omega * second.omega * second.to_global(j.second_arm) -
         first.omega * first.omega * first.to_global(j.first_arm);
}

double normal_gamma(const JointGeometry& j, const Frame& first, const Frame& second) {
  const NormalPlacement p(j, first, second);
  const Vector2d rate = second.velocity_at(p.a2) - first.velocity;
  return first.omega * first.omega * p.n.dot(p.e) - 2.0 * first.omega * quarter_turn(p.n).dot(rate) +
         second.omega * second.omega * p.n.dot(p.a2);
}

double distance_gamma(const JointGeometry& j, const Frame& first, const Frame& second) {
  const Placement p(j, first, second);
  const Vector2d rate = second.velocity_at(p.a2) - first.velocity_at(p.a1);
  return (p.d.dot(point_gamma(j, first, second)) - rate.squaredNorm()) / j.length;
}

void point_curvature(const JointGeometry& j, const Frame& first, const Frame& second, const Vector2d& lambda,
                     JointCurvature& K) {
  K(2, 2) += lambda.dot(first.to_global(j.first_arm));
  K(5, 5) -= lambda.dot(second.to_global(j.second_arm));
}

void normal_curvature(const NormalPlacement& p, double lambda, JointCurvature& K) {
  const Vector2d t = lambda * quarter_turn(p.n);
  const double lever = lambda * p.n.dot(p.a2);
  K.block<2, 1>(0, 2) -= t;
  K.block<1, 2>(2, 0) -= t.transpose();
  K.block<2, 1>(3, 2) += t;
  K.block<1, 2>(2, 3) += t.transpose();
  K(2, 2) -= lambda * p.n.dot(p.e);
  K(2, 5) += lever;
  K(5, 2) += lever;
  K(5, 5) -= lever;
}

void distance_curvature(const JointGeometry& j, const Frame& first, const Frame& second, double lambda,
                        JointCurvature& K) {
  const Placement p(j, first, second);
  Eigen::Matrix<double, 2, 6> d_q;
  d_q << -Eigen::Matrix2d::Identity(), -quarter_turn(p.a1), Eigen::Matrix2d::Identity(), quarter_turn(p.a2);
  const double force_per_length = lambda / j.length;
  K.noalias() += force_per_length * d_q.transpose() * d_q;
  point_curvature(j, first, second, force_per_length * p.d, K);
}

}  // namespace

int joint_rows(JointType type) {
  switch (type) {
    case JointType::revolute:
    case JointType::prismatic:
      return 2;
    case JointType::weld:
      return 3;
    case JointType::slot:
    case JointType::distance:
      return 1;
  }
  return 0;
}

bool has_angle_row(JointType type) { return type == JointType::prismatic || type == JointType::weld; }

JointGeometry joint_geometry(const Joint& joint, const Frame& first, const Frame& second, int row) {
  JointGeometry j;
  j.type = joint.type;
  j.first = joint.bodies[0];
  j.second = joint.bodies[1];
  j.row = row;
  const bool distance = joint.type == JointType::distance;
  j.first_arm = first.to_body((distance ? joint.from : joint.point) - first.origin);
  j.second_arm = second.to_body((distance ? joint.to : joint.point) - second.origin);
  if (joint.type == JointType::prismatic || joint.type == JointType::slot) {
    // a component of rounding size would only spoil the sparsity of Phi_q
    Vector2d n = -quarter_turn(joint.axis.normalized());
    for (double& component : n)
      if (std::abs(component) < 1e-15) component = 0.0;
    j.normal = first.to_body(n);
    j.offset = j.normal.dot(j.first_arm);
    j.friction = joint.friction;
  }
  j.angle = second.angle - first.angle;
  j.length = distance ? (joint.to - joint.from).norm() : 0.0;
  return j;
}

void joint_residual(const JointGeometry& j, const Frame& first, const Frame& second, double* Phi) {
  switch (j.type) {
    case JointType::revolute:
    case JointType::weld: {
      const Placement p(j, first, second);
      Phi[0] = p.d.x();
      Phi[1] = p.d.y();
      break;
    }
    case JointType::prismatic:
    case JointType::slot: {
      const NormalPlacement p(j, first, second);
      Phi[0] = p.n.dot(p.e) - j.offset;
      break;
    }
    case JointType::distance: {
      const Placement p(j, first, second);
      Phi[0] = (p.d.squaredNorm() - j.length * j.length) / (2.0 * j.length);
      break;
    }
  }
  if (has_angle_row(j.type)) Phi[joint_rows(j.type) - 1] = second.angle - first.angle - j.angle;
}

void joint_jacobian(const JointGeometry& j, const Frame& first, const Frame& second, JointJacobian& Phi_q) {
  switch (j.type) {
    case JointType::revolute:
    case JointType::weld:
      point_jacobian(j, first, second, Phi_q);
      break;
    case JointType::prismatic:
    case JointType::slot:
      normal_jacobian(j, first, second, Phi_q);
      break;
    case JointType::distance:
      distance_jacobian(j, first, second, Phi_q);
      break;
  }
  if (has_angle_row(j.type)) Phi_q.row(joint_rows(j.type) - 1) << 0.0, 0.0, -1.0, 0.0, 0.0, 1.0;
}

void joint_gamma(const JointGeometry& j, const Frame& first, const Frame& second, double* gamma) {
  switch (j.type) {
    case JointType::revolute:
    case JointType::weld: {
      const Vector2d value = point_gamma(j, first, second);
      gamma[0] = value.x();
      gamma[1] = value.y();
      break;
    }
    case JointType::prismatic:
    case JointType::slot:
      gamma[0] = normal_gamma(j, first, second);
      break;
    case JointType::distance:
      gamma[0] = distance_gamma(j, first, second);
      break;
  }
  if (has_angle_row(j.type)) gamma[joint_rows(j.type) - 1] = 0.0;
}

void joint_curvature(const JointGeometry& j, const Frame& first, const Frame& second, const double* lambda,
                     JointCurvature& curvature) {
  curvature.setZero();
  switch (j.type) {
    case JointType::revolute:
    case JointType::weld:
      point_curvature(j, first, second, {lambda[0], lambda[1]}, curvature);
      break;
    case JointType::prismatic:
    case JointType::slot:
      normal_curvature(NormalPlacement(j, first, second), lambda[0], curvature);
      break;
    case JointType::distance:
      distance_curvature(j, first, second, lambda[0], curvature);
      break;
  }
}

Eigen::Matrix<double, 6, 1> slide_gradient(const JointGeometry& j, const Frame& first, const Frame& second) {
  return NormalPlacement(j, quarter_turn(j.normal), first, second).gradient().transpose();
}

void slide_curvature(const JointGeometry& j, const Frame& first, const Frame& second, JointCurvature& curvature) {
  curvature.setZero();
  normal_curvature(NormalPlacement(j, quarter_turn(j.normal), first, second), 1.0, curvature);
}

Eigen::Vector3d joint_reaction(const JointGeometry& j, const Frame& first, const Frame& second, const double* lambda) {
  Vector2d force = Vector2d::Zero();
  switch (j.type) {
    case JointType::revolute:
    case JointType::weld:
      force = -Vector2d(lambda[0], lambda[1]);
      break;
    case JointType::prismatic:
    case JointType::slot:
      force = -lambda[0] * first.to_global(j.normal);
      break;
    case JointType::distance:
      force = -lambda[0] / j.length * Placement(j, first, second).d;
      break;
  }
  const double moment = has_angle_row(j.type) ? -lambda[joint_rows(j.type) - 1] : 0.0;
  return {force.x(), force.y(), moment};
}

}  // namespace traverse::multibody
