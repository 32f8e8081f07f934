// The free oscillations of natural modes that damping couples,
//
//   u'' + C u' + Omega^2 u = 0,   Omega diagonal, C symmetric,
//
// by the complex modes of that small system, each of which decays and turns by itself:
//
//   (Omega u, u') = Re sum_j s_j y_j e^(lambda_j t)
//
// Of a conjugate pair one member stands for both; those of overdamped motion are real. Where two of them are one, which
// critical damping makes them, there is no basis of complex modes: those of a C that is larger by 1e-10 are taken.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace traverse::structure {

struct ComplexModes {
  /// SolverError where none are found. omega in rad/s, all positive; sigma: half of C's diagonal, 1/s; cross_damping: C
  /// off its diagonal, 1/s.
  ComplexModes(const std::vector<double>& omega, const std::vector<double>& sigma,
               const Eigen::MatrixXd& cross_damping);

  Eigen::VectorXcd lambda;      // 1/s
  Eigen::MatrixXd state;        // (Omega u, u') of (Re y, Im y)
  Eigen::MatrixXd coordinates;  // (Re y, Im y) of (Omega u, u')

 private:
  void solve(const Eigen::MatrixXd& rates);
  double residual(const Eigen::MatrixXd& rates) const;
};

}  // namespace traverse::structure
