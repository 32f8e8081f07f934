// The free oscillations of natural modes that damping couples,
//
//   u'' + C u' + Omega^2 u = 0,   Omega diagonal, C symmetric,
//
// by the complex modes of this small system, each of which decays and oscillates independently:
//
//   (Omega u, u') = Re sum_j s_j y_j e^(lambda_j t)
//
// One member of each conjugate pair represents both; overdamped modes are real. With critical damping two modes
// coincide, and there is no basis of complex modes: then C is increased by a factor from 1 + 1e-10 on.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace traverse::structure {

struct ComplexModes {
  /// SolverError if no modes are found. omega in rad/s, all positive; sigma: half of C's diagonal, 1/s; cross_damping:
  /// C without its diagonal, 1/s.
  ComplexModes(const std::vector<double>& omega, const std::vector<double>& sigma,
               const Eigen::MatrixXd& cross_damping);

  Eigen::VectorXcd lambda;      // 1/s
  Eigen::MatrixXd state;        // matrix from (Re y, Im y) to (Omega u, u')
  Eigen::MatrixXd coordinates;  // matrix from (Omega u, u') to (Re y, Im y)

 private:
  void solve(const Eigen::MatrixXd& rates);
  double residual(const Eigen::MatrixXd& rates) const;
};

}  // namespace traverse::structure
