// Position and velocity of a body, the only data of a body that joints and force elements use.
#pragma once

#include <Eigen/Core>

namespace traverse::multibody {

/// The vector rotated by 90 degrees counter-clockwise: the derivative of a rotating vector with respect to its angle.
inline Eigen::Vector2d quarter_turn(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

/// Position and velocity of a body; the default values are the fixed ground.
struct Frame {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();    // m, centre of mass
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  // m/s
  double angle = 0.0;                                  // rad
  double cosine = 1.0;
  double sine = 0.0;
  double omega = 0.0;  // rad/s

  /// A body-fixed vector in global components.
  Eigen::Vector2d to_global(const Eigen::Vector2d& v) const {
    return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y()};
  }
  /// A global vector in body-fixed components.
  Eigen::Vector2d to_body(const Eigen::Vector2d& v) const {
    return {cosine * v.x() + sine * v.y(), -sine * v.x() + cosine * v.y()};
  }
  /// Velocity of the point at `arm` (global components, from the centre of mass).
  Eigen::Vector2d velocity_at(const Eigen::Vector2d& arm) const { return velocity + omega * quarter_turn(arm); }

  /// Sets the angle, rad, with its cosine and sine.
  void set_angle(double value);
  /// Serialises all members.
  template <class Bytes>
  void keep(Bytes& bytes) {
    bytes(origin, velocity, angle, cosine, sine, omega);
  }
};

}  // namespace traverse::multibody
