// The estimates of a fit with their standard errors and correlations, and sentences on what the data do not determine.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fit/minimise.hpp"
#include "fit/residuals.hpp"

namespace traverse::fit {

/// The estimate of an unknown.
struct Estimate {
  double value = 0.0;
  double standard_error = 0.0;  // NaN at a bound; infinite if the data do not determine it
  bool at_bound = false;
};

struct Estimates {
  std::vector<Estimate> of;     // in the order of the unknowns
  Eigen::MatrixXd correlation;  // NaN where a standard error is not finite
  double ratio = 0.0;           // sum of the squares of the residuals over the degrees of freedom; NaN without any
  std::vector<std::string> sentences;
};

/// Linearised about the minimum: the covariance is the inverse of J^T J. The standard errors are multiplied by the root
/// of `ratio` where it is larger than chance explains, so that an imperfect model does not seem precise.
Estimates estimates_of(const Minimum& minimum, const Residuals& residuals);

/// A minimum that several minimisations reached.
struct DistinctMinimum {
  const Minimum* best = nullptr;
  int count = 0;  // minimisations that ended there
};
/// The minima that differ from each other, by ascending misfit: those of which the linearised residuals of one do not
/// explain the other. Minimisations that have not converged are left out, except for the one with the least misfit.
std::vector<DistinctMinimum> distinct_minima(const std::vector<Minimum>& minima);

}  // namespace traverse::fit
