// The velocities of a vehicle that follows the surface it starts on. At rest its coordinates are p(s), s its place on
// the track: where it goes on at the speed v in equilibrium, p' = v dp/ds. With the slopes h' under its wheels and
// contacts that are stiff beside its springs, K dp/ds is balanced by the contacts and G dp/ds = h', where G says how
// the wheels move up with p: the motion that stretches the springs least.
//
// Masses on springs follow a slope that lasts, as of a ramp, and not one that a measured track has for a metre. There
// the wheels alone follow, as an impulse at the contacts would have them do: the motion of the least kinetic energy. So
// p' = v (A h_lasting' + C (h' - h_lasting')), with G A = G C = 1.
#pragma once

#include <Eigen/Dense>

#include "traverse/track/profile.hpp"

namespace traverse::train {

class Following {
 public:
  /// M and K (f x f, kg and N/m) and G (r x f): what the coordinates that follow and the contacts have.
  Following(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K, const Eigen::MatrixXd& G);
  /// From how fast the surface rises under each wheel, as it is and as it lasts, m/s.
  Eigen::VectorXd rates(const Eigen::VectorXd& rise, const Eigen::VectorXd& lasting) const {
    return lasting_ * lasting + sudden_ * (rise - lasting);
  }

 private:
  Eigen::MatrixXd lasting_, sudden_;  // A and C
};

/// What lasts of a profile's slope at x: the middle one of this slope and the mean slopes before and behind.
double lasting_slope(const track::Profile& profile, double x, double slope);

}  // namespace traverse::train
