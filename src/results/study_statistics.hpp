// Statistics of a study over some of its axes: means, deviations, and quantiles with their confidence intervals.
#pragma once

#include <utility>
#include <vector>

#include "results/study_table.hpp"

namespace traverse::results {

/// Ranks of order statistics, from 1: with at least the given confidence the p-quantile of the samples' distribution is
/// between the lower-th and the upper-th smallest of n, for any distribution (W. J. Conover, Practical nonparametric
/// statistics, 3.2). The probability of each side is at most half of the remaining one. lower 0 or upper n + 1: too few
/// samples for a bound on this side.
struct RankInterval {
  std::size_t lower = 0, upper = 0;
};
RankInterval quantile_ranks(std::size_t n, double p, double confidence);

/// The p-quantile of ascending samples, by linear interpolation between order statistics (R's type 7).
double quantile(const std::vector<double>& ascending, double p);

class StudyStatistics {
 public:
  explicit StudyStatistics(const StudyTable& table);

  /// Statistics of one number (a column at a probe) over the finished runs of a group.
  struct Numbers {
    std::size_t samples = 0;
    double mean = 0.0, deviation = 0.0;       // deviation of the samples, with n - 1
    std::vector<double> quantile, low, high;  // NaN without a bound
  };
  std::size_t groups() const { return groups_.size(); }
  Numbers of(std::size_t group, const StudyTable::Column& column, std::size_t probe) const;

  /// Datasets under /study/statistics.
  std::vector<Recorder::Dataset> datasets() const;
  void print() const;

 private:
  const StudyTable& table_;
  std::vector<const options::StudyDimension*> dimensions_;  // dimensions by which groups differ
  std::vector<std::vector<std::size_t>> groups_;            // runs
};

}  // namespace traverse::results
