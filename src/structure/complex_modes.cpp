#include "structure/complex_modes.hpp"

#include <Eigen/Dense>

namespace traverse::structure {

ComplexModes::ComplexModes(const std::vector<double>& omega, const std::vector<double>& sigma,
                           const Eigen::MatrixXd& cross_damping) {
  const auto m = static_cast<Eigen::Index>(omega.size());
  const Eigen::Map<const Eigen::VectorXd> frequency(omega.data(), m), decay(sigma.data(), m);
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(2 * m, 2 * m);
  rates.topRightCorner(m, m) = frequency.asDiagonal();
  rates.bottomLeftCorner(m, m) = -rates.topRightCorner(m, m);
  rates.bottomRightCorner(m, m) = -cross_damping;
  rates.bottomRightCorner(m, m).diagonal() -= 2.0 * decay;

  const Eigen::EigenSolver<Eigen::MatrixXd> solver(rates);
  const Eigen::MatrixXcd shapes = solver.eigenvectors(), inverse = shapes.inverse();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = 0; j < 2 * m; ++j)
    if (solver.eigenvalues()[j].imag() >= 0.0) kept.push_back(j);
  const auto count = static_cast<Eigen::Index>(kept.size());
  lambda.resize(count);
  state.resize(2 * m, 2 * count);
  coordinates.resize(2 * count, 2 * m);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index j = kept[static_cast<std::size_t>(k)];
    lambda[k] = solver.eigenvalues()[j];
    const double both = lambda[k].imag() > 0.0 ? 2.0 : 1.0;
    state.col(k) = both * shapes.col(j).real();
    state.col(count + k) = -both * shapes.col(j).imag();
    coordinates.row(k) = inverse.row(j).real();
    coordinates.row(count + k) = inverse.row(j).imag();
  }
}

}  // namespace traverse::structure
