// Minimises p'^T K p' (lasting slopes) or p'^T M p' (short slopes) subject to G p' = v h', by a complete orthogonal
// decomposition of the Lagrange multiplier equations.
#include "train/following.hpp"

#include <algorithm>

namespace traverse::train {
namespace {

constexpr double long_stretch =
    20.0;  // m: length over which a slope is lasting; the fade-in of spectra has this length

/// p with the least p^T A p / 2 and G p = 1, by columns: A p + G^T lambda = 0. Coordinates that A and G do not
/// determine remain zero, and dependent contact conditions are satisfied together.
Eigen::MatrixXd least_energy_motion(const Eigen::MatrixXd& A, const Eigen::MatrixXd& G) {
  const Eigen::Index f = A.rows(), r = G.rows();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(f + r, f + r), right = Eigen::MatrixXd::Zero(f + r, r);
  const double scale = A.diagonal().cwiseAbs().maxCoeff();
  if (scale > 0.0) system.topLeftCorner(f, f) = A / scale;
  system.topRightCorner(f, r) = G.transpose();
  system.bottomLeftCorner(r, f) = G;
  right.bottomRows(r).setIdentity();
  return system.completeOrthogonalDecomposition().solve(right).topRows(f);
}

}  // namespace

Following::Following(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K, const Eigen::MatrixXd& G)
    : lasting_(least_energy_motion(K, G)), sudden_(least_energy_motion(M, G)) {}

double lasting_slope(const track::Profile& profile, double x, double slope) {
  const double height = profile.at(x).value;
  const double before = (height - profile.at(x - long_stretch).value) / long_stretch;
  const double ahead = (profile.at(x + long_stretch).value - height) / long_stretch;
  return std::clamp(slope, std::min(before, ahead), std::max(before, ahead));
}

}  // namespace traverse::train
