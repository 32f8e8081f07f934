// The initial velocities of a vehicle that follows the surface. In equilibrium its coordinates are p(s), with its
// position s on the track; moving in equilibrium at the speed v it has p' = v dp/ds. With the slopes h' under its
// wheels, and contacts that are stiff compared with its springs, the contact forces balance K dp/ds, and G dp/ds = h',
// where G gives the upward displacements of the wheels for p: the motion with the least strain energy of the springs.
//
// Suspended masses follow a long slope, such as a ramp, but not a slope that a measured track has over a metre. There
// only the wheels follow, as under an impulse at the contacts: the motion with the least kinetic energy. Therefore p' =
// v (A h_lasting' + C (h' - h_lasting')), with G A = G C = 1.
#pragma once

#include <Eigen/Dense>

#include "traverse/track/profile.hpp"

namespace traverse::train {

class Following {
 public:
  /// M and K (f x f, kg and N/m) of the following coordinates, and G (r x f) of the contacts.
  Following(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K, const Eigen::MatrixXd& G);
  /// The initial rates of the following coordinates, from the actual and the lasting rise of the surface under each
  /// wheel in time, m/s.
  Eigen::VectorXd rates(const Eigen::VectorXd& rise, const Eigen::VectorXd& lasting) const {
    return lasting_ * lasting + sudden_ * (rise - lasting);
  }

 private:
  Eigen::MatrixXd lasting_, sudden_;  // A and C
};

/// The lasting part of a profile's slope at x: the median of this slope and the mean slopes before and behind.
double lasting_slope(const track::Profile& profile, double x, double slope);

}  // namespace traverse::train
