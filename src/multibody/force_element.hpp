// Springs, dampers and torsion springs between two bodies, with their derivatives and energies.
// Generalized forces are parts of g in eq. 42 of the paper, columns x1 y1 phi1 x2 y2 phi2.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "traverse/multibody/frame.hpp"
#include "traverse/multibody/model.hpp"

namespace traverse::multibody {

using PairForce = Eigen::Matrix<double, 6, 1>;
using PairMatrix = Eigen::Matrix<double, 6, 6>;

/// A spring in body-fixed components: tension = preload + stiffness*(length - reference_length) + damping*rate, or
/// law(length - reference_length, rate).
struct SpringGeometry {
  int first = ground;
  int second = ground;
  Eigen::Vector2d first_arm = Eigen::Vector2d::Zero();   // m, to `from`, in the first body
  Eigen::Vector2d second_arm = Eigen::Vector2d::Zero();  // m, to `to`, in the second body
  double stiffness = 0.0;                                // N/m
  double damping = 0.0;                                  // N s/m
  double reference_length = 0.0;                         // m
  double preload = 0.0;                                  // N, at the reference length
  double reference_rate = 0.0;                           // m/s, of the reference length
  std::shared_ptr<const base::ForceLaw> law;             // null: linear
  std::shared_ptr<base::TimeFunction> winding;           // null: the reference length is constant
};

/// The spring with its reference length and its rate at time t.
inline SpringGeometry wound(const SpringGeometry& spring, double t) {
  SpringGeometry at = spring;
  at.reference_length += spring.winding->value(t);
  at.reference_rate = spring.winding->rate(t);
  return at;
}

struct TorsionGeometry {
  int first = ground;
  int second = ground;
  double stiffness = 0.0;                               // N m/rad
  double damping = 0.0;                                 // N m s/rad
  double free_angle = 0.0;                              // rad
  std::shared_ptr<const base::ForceLaw> law = nullptr;  // null: linear
};

/// `first` and `second` are the bodies' frames at t = 0.
SpringGeometry spring_geometry(const Spring& spring, const Frame& first, const Frame& second);
TorsionGeometry torsion_geometry(const TorsionSpring& spring, const Frame& first, const Frame& second);

/// Generalized force on both bodies. A spring whose length is zero has no direction: its force is stiffness times
/// displacement if it is a zero-length spring, and zero otherwise.
PairForce spring_force(const SpringGeometry& spring, const Frame& first, const Frame& second);
/// Like the function above; it also adds the power dissipated in the damper, W, to `dissipation`.
PairForce spring_force(const SpringGeometry& spring, const Frame& first, const Frame& second, double& dissipation);
double spring_length(const SpringGeometry& spring, const Frame& first, const Frame& second);  // m
/// Tension along the spring, N, including the damper.
double spring_tension(const SpringGeometry& spring, const Frame& first, const Frame& second);
/// Derivatives of spring_force with respect to the coordinates and to the velocities.
void spring_derivatives(const SpringGeometry& spring, const Frame& first, const Frame& second, PairMatrix& g_q,
                        PairMatrix& g_qd);
/// Stored energy, J; its derivative over length is the elastic tension. It is zero where that tension is zero; with a
/// preload and no stiffness, and with a law, it is zero at the reference length.
double spring_strain_energy(const SpringGeometry& spring, const Frame& first, const Frame& second);
/// Power dissipated in the damper, W, >= 0.
double spring_dissipation(const SpringGeometry& spring, const Frame& first, const Frame& second);

/// Moment on the second body; the opposite moment acts on the first body.
double torsion_moment(const TorsionGeometry& spring, const Frame& first, const Frame& second);
/// Decrease of the moment on the second body per twist and per rate of twist.
struct TorsionTangent {
  double stiffness = 0.0;  // N m/rad
  double damping = 0.0;    // N m s/rad
};
TorsionTangent torsion_tangent(const TorsionGeometry& spring, const Frame& first, const Frame& second);
double torsion_strain_energy(const TorsionGeometry& spring, const Frame& first, const Frame& second);
double torsion_dissipation(const TorsionGeometry& spring, const Frame& first, const Frame& second);

}  // namespace traverse::multibody
