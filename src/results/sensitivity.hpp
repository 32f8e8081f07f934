// Estimators of a sensitivity analysis from the results at the points of its design (base/sampling_design.hpp). Each
// factor is a varied option with a distribution.
#pragma once

#include <string>
#include <vector>

#include "results/study_table.hpp"

namespace traverse::results {

/// An estimate with its confidence interval by bootstrap over the samples or trajectories of the design.
struct IndexEstimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// Sobol' indices of one factor: the part of the variance due to the factor alone (estimator of Saltelli et al. 2010),
/// and the part of all its effects (M. J. W. Jansen, Computer Physics Communications 117 (1999) 35).
struct SobolIndices {
  IndexEstimate first, total;
};
/// values: the quantity at the rows A, AB_1, ..., AB_factors, B of each sample.
std::vector<SobolIndices> sobol_indices(const std::vector<double>& values, std::size_t factors, double confidence,
                                        std::uint64_t seed);

/// Morris' elementary effects of one factor, the change of the quantity over the range of the factor: mean, mean of the
/// magnitudes (F. Campolongo et al., Environmental Modelling & Software 22 (2007) 1509), standard deviation.
struct MorrisMeasures {
  double mean = 0.0, deviation = 0.0;
  IndexEstimate magnitude;
};
/// values: the quantity at the points of each trajectory; step: for each trajectory and factor, the index of the point
/// that changes the factor, positive if the factor grows, otherwise negative.
std::vector<MorrisMeasures> morris_measures(const std::vector<double>& values, const std::vector<int>& step,
                                            std::size_t factors, double confidence, std::uint64_t seed);

/// The derivative of a quantity with respect to one factor at the nominal point, by a central difference; error: half
/// the difference between those to either side, which the curvature or a kink makes and which exceeds the error.
struct LocalDerivative {
  double value = 0.0, error = 0.0;
};
/// values: at the nominal point, then for each factor + and - its step.
std::vector<LocalDerivative> local_derivatives(const std::vector<double>& values, const std::vector<double>& steps);

/// The analysis of a study: every peak and every limited quantity, each at the greatest value of all runs that differ
/// in other options than the factors.
class SensitivityAnalysis {
 public:
  /// The study of the table has a sensitivity analysis.
  explicit SensitivityAnalysis(const StudyTable& table);

  /// /sensitivity of the results file.
  void record(Recorder& recorder) const;
  void print() const;

 private:
  struct Quantity {
    std::string name, unit;
    std::vector<double> values;  // at the points; NaN: not known at one of them
    bool known = false;
  };
  void add(const std::string& name, const std::string& unit, const StudyTable::Column& column, std::size_t first,
           std::size_t count);
  std::vector<double> nominal() const;
  /// Names of the numbers of a factor, and the numbers [factors][names] of a quantity.
  std::vector<std::string> measures() const;
  std::vector<double> numbers(const Quantity& quantity) const;

  const StudyTable& table_;
  const options::Sensitivity& design_;
  std::vector<const options::StudyDimension*> factors_;
  std::vector<Quantity> quantities_;
};

}  // namespace traverse::results
