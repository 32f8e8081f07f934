// Geometry of a joint in the body-fixed frames of its two bodies, and first and second derivatives of the displacement
// along its sliding direction.
#include "multibody/joint.hpp"

#include "equations/normal.hpp"

namespace traverse::multibody {

using equations::NormalPlacement;

JointGeometry joint_geometry(const Joint& joint, const Frame& first, const Frame& second, int row) {
  JointGeometry j;
  j.type = joint.type;
  j.first = joint.bodies[0];
  j.second = joint.bodies[1];
  j.row = row;
  const JointNeeds& needs = joint.type->needs;
  if (needs.point || needs.ends) {
    j.first_arm = first.to_body((needs.ends ? joint.from : joint.point) - first.origin);
    j.second_arm = second.to_body((needs.ends ? joint.to : joint.point) - second.origin);
  }
  if (joint.type->slides) j.friction = joint.friction;
  j.numbers = joint.numbers;
  joint.type->prepare(joint, first, second, j);
  return j;
}

Eigen::Matrix<double, 6, 1> slide_gradient(const JointGeometry& j, const Frame& first, const Frame& second) {
  return NormalPlacement(j, quarter_turn(j.normal), first, second).gradient().transpose();
}

void slide_curvature(const JointGeometry& j, const Frame& first, const Frame& second, JointCurvature& curvature) {
  curvature.setZero();
  NormalPlacement(j, quarter_turn(j.normal), first, second).add_curvature(1.0, curvature);
}

}  // namespace traverse::multibody
