// Solves the eigenvalue problem of the first-order system in (Omega u, u'), keeps one of each conjugate pair, and
// perturbs the damping slightly where no complete set of eigenvectors exists.
#include "structure/complex_modes.hpp"

#include <Eigen/Dense>

#include "traverse/base/error.hpp"

namespace traverse::structure {
namespace {

constexpr double residual_tolerance = 1e-9;  // residual of the complex modes over the norm of the matrix
constexpr double least_change = 1e-10;       // relative change of C if there are none
constexpr double most_change = 1e-6;

}  // namespace

ComplexModes::ComplexModes(const std::vector<double>& omega, const std::vector<double>& sigma,
                           const Eigen::MatrixXd& cross_damping) {
  const auto m = static_cast<Eigen::Index>(omega.size());
  const Eigen::Map<const Eigen::VectorXd> frequency(omega.data(), m), decay(sigma.data(), m);
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(2 * m, 2 * m);  // time derivative of (Omega u, u')
  rates.topRightCorner(m, m) = frequency.asDiagonal();
  rates.bottomLeftCorner(m, m) = -rates.topRightCorner(m, m);
  rates.bottomRightCorner(m, m) = -cross_damping;
  rates.bottomRightCorner(m, m).diagonal() -= 2.0 * decay;
  solve(rates);
  Eigen::MatrixXd changed = rates;
  for (double change = least_change; !(residual(rates) <= residual_tolerance + 2.0 * change); change *= 10.0) {
    if (change > most_change)
      throw SolverError("the complex modes of the damped bridge were not found; take other model_modes, or 0");
    changed.bottomRightCorner(m, m) = (1.0 + change) * rates.bottomRightCorner(m, m);
    solve(changed);
  }
}

void ComplexModes::solve(const Eigen::MatrixXd& rates) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(rates);
  const Eigen::MatrixXcd shapes = solver.eigenvectors(), inverse = shapes.inverse();
  std::vector<Eigen::Index> selected;
  for (Eigen::Index j = 0; j < rates.cols(); ++j)
    if (solver.eigenvalues()[j].imag() >= 0.0) selected.push_back(j);
  const auto count = static_cast<Eigen::Index>(selected.size());
  lambda.resize(count);
  state.resize(rates.cols(), 2 * count);
  coordinates.resize(2 * count, rates.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index j = selected[static_cast<std::size_t>(k)];
    lambda[k] = solver.eigenvalues()[j];
    const double pair_factor = lambda[k].imag() > 0.0 ? 2.0 : 1.0;
    state.col(k) = pair_factor * shapes.col(j).real();
    state.col(count + k) = -pair_factor * shapes.col(j).imag();
    coordinates.row(k) = inverse.row(j).real();
    coordinates.row(count + k) = inverse.row(j).imag();
  }
}

/// The difference between the matrix of these modes and `rates`, over its norm.
double ComplexModes::residual(const Eigen::MatrixXd& rates) const {
  const Eigen::Index count = lambda.size();
  const auto re = coordinates.topRows(count), im = coordinates.bottomRows(count);
  Eigen::MatrixXd rotated(2 * count, rates.cols());
  rotated.topRows(count) = lambda.real().asDiagonal() * re - lambda.imag().asDiagonal() * im;
  rotated.bottomRows(count) = lambda.imag().asDiagonal() * re + lambda.real().asDiagonal() * im;
  return (state * rotated - rates).norm() / rates.norm();
}

}  // namespace traverse::structure
