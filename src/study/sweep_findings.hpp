// Results of a sweep in addition to the table of its runs: resonance and cancellation speeds, and the verdict of EN
// 1991-2.
#pragma once

#include <optional>
#include <vector>

#include "ensemble/case_runner.hpp"
#include "norm/dynamic_verdict.hpp"
#include "results/resonance.hpp"
#include "results/study_table.hpp"

namespace traverse::study {

class SweepFindings {
 public:
  /// Scene and runner must outlive this object.
  SweepFindings(const scene::Scene& scene, const ensemble::CaseRunner& runner);

  /// Resonance speeds (m/s) whose peaks are not resolved by the runner's speeds.
  std::vector<double> unresolved_speeds() const;
  /// The width of the first mode's resonances at half power, relative to the speed.
  double width_of_resonance() const;
  /// Computes the peaks near resonances and, if all runs have ended, the verdict of EN 1991-2.
  void finish(const results::StudyTable& table);
  /// Appends the results of EN 1991-2 to the verdicts on limits.
  void add_to(std::vector<results::Verdict>& verdicts) const;
  void record(results::Recorder& recorder) const;
  void print() const;

 private:
  const scene::Scene& scene_;
  const ensemble::CaseRunner& runner_;
  std::vector<double> frequencies_;  // Hz
  std::vector<results::Resonance> resonances_;
  std::vector<results::Cancellation> cancellations_;
  std::optional<norm::NormCheck> check_;
};

}  // namespace traverse::study
