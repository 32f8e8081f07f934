// Geometry of a joint in the body-fixed frames of its two bodies, and first and second derivatives of the displacement
// along its sliding direction. Sine and cosine of a body's angle, by power series for angles below 0.1 rad.
#include "multibody/joint.hpp"

#include <cmath>

#include "equations/normal.hpp"

namespace traverse::multibody {
namespace {

constexpr double small_angle = 0.1;  // rad: for smaller angles the series below are exact to rounding

}  // namespace

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

void Frame::set_angle(double value) {
  angle = value;
  if (std::abs(value) < small_angle) {
    const double x = value * value;
    cosine = 1.0 - x * (1.0 / 2.0) *
                       (1.0 - x * (1.0 / 12.0) *
                                  (1.0 - x * (1.0 / 30.0) * (1.0 - x * (1.0 / 56.0) * (1.0 - x * (1.0 / 90.0)))));
    sine = value *
           (1.0 - x * (1.0 / 6.0) * (1.0 - x * (1.0 / 20.0) * (1.0 - x * (1.0 / 42.0) * (1.0 - x * (1.0 / 72.0)))));
    return;
  }
  cosine = std::cos(value);
  sine = std::sin(value);
}

}  // namespace traverse::multibody
