#include "train/following.hpp"

#include <algorithm>

namespace traverse::train {
namespace {

constexpr double long_stretch = 20.0;  // m: over which a slope lasts; spectra fade in over as much
constexpr double stiff = 1e9;          // contacts, over what they are beside
constexpr double slow = 1e-3;          // rad/s: what no spring holds stays at rest, if the wheels let it

/// p with the least p^T A p / 2 and G p = 1, by columns.
Eigen::MatrixXd least(const Eigen::MatrixXd& A, const Eigen::MatrixXd& G) {
  const Eigen::MatrixXd GtG = G.transpose() * G;
  const double s = stiff * A.diagonal().cwiseAbs().maxCoeff() / GtG.diagonal().maxCoeff();
  return (A + s * GtG).partialPivLu().solve(s * G.transpose());
}

}  // namespace

Following::Following(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K, const Eigen::MatrixXd& G)
    : lasting_(least(K + slow * slow * M, G)), sudden_(least(M, G)) {}

double lasting_slope(const track::Profile& profile, double x, double slope) {
  const double here = profile.at(x).value;
  const double before = (here - profile.at(x - long_stretch).value) / long_stretch;
  const double ahead = (profile.at(x + long_stretch).value - here) / long_stretch;
  return std::clamp(slope, std::min(before, ahead), std::max(before, ahead));
}

}  // namespace traverse::train
