// Minimises the misfit, half the sum of the squares of all residuals, within the bounds of the unknowns by PETSc's TAO.
#pragma once

#include <Eigen/Core>
#include <string>

#include "fit/evaluator.hpp"
#include "fit/residuals.hpp"

namespace traverse::fit {

/// The end of a minimisation.
struct Minimum {
  Eigen::VectorXd u;          // unknowns between 0 and 1
  Eigen::VectorXd residuals;  // over their standard deviations
  Eigen::MatrixXd jacobian;   // d residuals / d u
  long iterations = 0;
  std::string reason;  // PETSc's name of the reason of the end

  double misfit() const { return 0.5 * residuals.squaredNorm(); }
};

/// The residuals and their derivatives, both on rank 0.
class Problem {
 public:
  Problem(Evaluator& evaluator, const Residuals& residuals) : evaluator_(evaluator), residuals_(residuals) {}

  /// Selects the steps of the differences at this point: large against the rounding errors of the residuals, which
  /// differences of order four between close points show, and small against the scale of their changes.
  void set_steps(const Eigen::VectorXd& u);
  Eigen::VectorXd evaluate(const Eigen::VectorXd& u) const;
  /// The derivatives of the residuals by central differences. The runs of all points are distributed over the ranks;
  /// shifts and offsets need no runs.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& u) const;
  std::vector<double> response(const Eigen::VectorXd& u) const;
  const Residuals& residuals() const { return residuals_; }

 private:
  std::vector<Eigen::VectorXd> evaluate(const std::vector<Eigen::VectorXd>& points) const;

  Evaluator& evaluator_;
  const Residuals& residuals_;
  double step_ = 1e-4;  // of u
};

/// Minimises from u, with PETSc's options -tao_...
Minimum minimise(Problem& problem, const Eigen::VectorXd& u);

/// Whether the linearised residuals promise no noteworthy decrease of the misfit within the bounds.
bool has_converged(const Minimum& minimum);
/// Which unknowns are at a bound towards which the misfit decreases.
std::vector<char> at_bounds(const Minimum& minimum);

}  // namespace traverse::fit
