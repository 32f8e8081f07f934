// Applies the inverse of the linearised quadratic eigenvalue problem by one banded solve with K, with rigid-body
// motions treated separately by their mass and damping.
#include <cmath>
#include <limits>

#include "quadratic.hpp"

namespace traverse::modes {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd times(const Band& A, double factor, const MatrixXd& X) {
  MatrixXd Y = MatrixXd::Zero(X.rows(), X.cols());
  for (Eigen::Index c = 0; c < X.cols(); ++c) add_product(A, factor, X.col(c).data(), Y.col(c).data());
  return Y;
}

/// Bound of the rounding error of x^T C x. A non-zero D has the rounding error of b K.
double rounding(const Segment& s, const beam::Rayleigh& ab, const VectorXd& x) {
  double sum = 0.0;
  for (int i = 0; i < s.size(); ++i) {
    for (int j = std::max(0, i - s.D.width()); j <= i; ++j) {
      const double size = std::abs(x[i] * x[j]) * (i == j ? 1.0 : 2.0), D = std::abs(s.D.at(i, j));
      sum += size * (std::abs(ab.a * s.M.at(i, j)) + D);
      if (D > 0.0) sum += size * std::abs(ab.b * s.K.at(i, j));
    }
  }
  return 16.0 * std::numeric_limits<double>::epsilon() * sum;
}

/// The order of magnitude of the lowest non-zero frequency, rad/s.
double typical_frequency(const Segment& s) {
  const Bracket lowest = s.rigid.empty() ? bracket_lowest(s.K, s.M) : Bracket{};
  if (lowest.low > 0.0) return std::sqrt(lowest.high);
  // The ratio of squared frequencies grows with the fourth power of the number of elements for a beam, with the second
  // power for a bar.
  const double elements = std::max(1.0, static_cast<double>(s.nodes.back() - s.nodes.front()));
  return std::sqrt(highest_quotient(s.K, s.M) / std::pow(elements, s.order()));
}

}  // namespace

Inverse::Inverse(const Segment& segment, beam::Rayleigh ab)
    : s_(segment), ab_(ab), scale_(typical_frequency(segment)), root_mass_(segment.size()) {
  for (int i = 0; i < unknowns(); ++i) root_mass_[i] = std::sqrt(s_.M.at(i, i));
  if (!s_.rigid.empty()) prepare_motions();
  stiffness_ = Factor(restrained_stiffness());
  if (!stiffness_.positive()) {
    throw SolverError(
        "modes: the stiffness that holds the beam is lost beside that of its elements; use fewer elements or a stiffer "
        "foundation");
  }
}

void Inverse::prepare_motions() {
  MatrixXd basis(unknowns(), static_cast<Eigen::Index>(s_.rigid.size()));
  for (Eigen::Index c = 0; c < basis.cols(); ++c) {
    basis.col(c) = VectorXd::Map(s_.rigid[static_cast<std::size_t>(c)].data(), unknowns());
  }
  const auto damping = [&](const MatrixXd& X) -> MatrixXd { return times(s_.M, ab_.a, X) + times(s_.D, 1.0, X); };
  // The motions with the least damping first.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> principal(basis.transpose() * damping(basis),
                                                                     basis.transpose() * times(s_.M, 1.0, basis));
  motions_ = basis * principal.eigenvectors();
  mass_motions_ = times(s_.M, 1.0, motions_);
  damped_motions_ = damping(motions_);
  rates_ = principal.eigenvalues();
  double least = 0.0;
  for (int k = 0; k < rigid(); ++k) least = std::max(least, rounding(s_, ab_, motions_.col(k)));
  while (undamped_ < rigid() && std::abs(rates_[undamped_]) <= least) ++undamped_;
}

Band Inverse::restrained_stiffness() {
  Band K = s_.K;
  if (rigid() == 0) return K;
  // Displacements in which the motions are largest and linearly independent.
  MatrixXd displacements = motions_.transpose();
  for (int i = 0; i < unknowns(); ++i) {
    if (s_.slope[static_cast<std::size_t>(i)] != 0) displacements.col(i).setZero();
  }
  const Eigen::ColPivHouseholderQR<MatrixXd> pivoting(displacements);
  for (int k = 0; k < rigid(); ++k) {
    const int i = static_cast<int>(pivoting.colsPermutation().indices()[k]);
    held_.push_back(i);
    for (int j = std::max(0, i - K.width()); j < i; ++j) K.at(i, j) = 0.0;
    for (int j = i + 1; j <= std::min(K.size() - 1, i + K.width()); ++j) K.at(j, i) = 0.0;
  }
  return K;
}

void Inverse::apply(const double* state, double* result) const {
  const int n = unknowns();
  VectorXd x = VectorXd::Map(state, n).cwiseQuotient(root_mass_);
  const VectorXd z = VectorXd::Map(state + n, n).cwiseQuotient(root_mass_);
  if (undamped_ > 0) x -= motions_.leftCols(undamped_) * (mass_motions_.leftCols(undamped_).transpose() * x);

  // -K^-1 (C x + M z) without the part b K of C.
  VectorXd x_new = VectorXd::Zero(n);
  add_product(s_.M, -ab_.a, x.data(), x_new.data());
  add_product(s_.D, -1.0, x.data(), x_new.data());
  add_product(s_.M, -scale_, z.data(), x_new.data());
  if (rigid() > 0) x_new -= mass_motions_ * (motions_.transpose() * x_new);
  for (int i : held_) x_new[i] = 0.0;
  stiffness_.solve(x_new.data());
  x_new -= ab_.b * x;
  if (rigid() > 0) add_motions(x, x_new);

  VectorXd::Map(result, n) = x_new.cwiseProduct(root_mass_);
  VectorXd::Map(result + n, n) = x.cwiseProduct(root_mass_) / scale_;
}

void Inverse::add_motions(const VectorXd& x, VectorXd& x_new) const {
  VectorXd part = mass_motions_.transpose() * x + damped_motions_.transpose() * x_new;
  part = -part.cwiseQuotient(rates_);
  part.head(undamped_) = -mass_motions_.leftCols(undamped_).transpose() * x_new;
  x_new += motions_ * part;
}

}  // namespace traverse::modes
