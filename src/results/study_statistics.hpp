// Statistics of a study over some of its axes: means, deviations, and quantiles with their confidence intervals.
#pragma once

#include <utility>
#include <vector>

#include "results/study_table.hpp"

namespace traverse::results {

/// Ranks of order statistics, from 1: with at least the given confidence the p-quantile of what the samples are drawn
/// from lies between the lower-th and the upper-th smallest of n, whatever the distribution is (W. J. Conover,
/// Practical nonparametric statistics, 3.2). Each side is missed with at most half of what is left of the confidence;
/// lower 0 or upper n + 1: so few samples bound that side by nothing.
struct RankInterval {
  std::size_t lower = 0, upper = 0;
};
RankInterval quantile_ranks(std::size_t n, double p, double confidence);

/// The p-quantile of ascending samples, by straight lines between order statistics (R's type 7).
double quantile(const std::vector<double>& ascending, double p);

class StudyStatistics {
 public:
  explicit StudyStatistics(const StudyTable& table);

  /// Of one number (a column at a probe) over the finished runs of a group.
  struct Numbers {
    std::size_t samples = 0;
    double mean = 0.0, deviation = 0.0;       // the latter of the samples, n - 1
    std::vector<double> quantile, low, high;  // NaN where nothing bounds them
  };
  std::size_t groups() const { return groups_.size(); }
  Numbers of(std::size_t group, const StudyTable::Column& column, std::size_t probe) const;

  /// Under /study/statistics.
  std::vector<Recorder::Dataset> datasets() const;
  void print() const;

 private:
  const StudyTable& table_;
  std::vector<const options::StudyDimension*> dimensions_;  // that tell groups apart
  std::vector<std::vector<std::size_t>> groups_;            // runs
};

}  // namespace traverse::results
