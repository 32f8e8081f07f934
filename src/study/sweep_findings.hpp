// What a sweep has besides the table of its runs: speeds of resonance and of cancellation, and the verdict of
// EN 1991-2 on its trains.
#pragma once

#include <optional>
#include <vector>

#include "ensemble/case_runner.hpp"
#include "norm/dynamic_verdict.hpp"
#include "results/resonance.hpp"
#include "results/study_table.hpp"

namespace traverse::app {

class SweepFindings {
 public:
  /// Both must outlive it.
  SweepFindings(const Scene& scene, const CaseRunner& runner);

  /// m/s, speeds of resonance whose peaks would lie unseen between those of the runner.
  std::vector<double> unseen_speeds() const;
  /// The width of the first mode's resonances at half their power, relative to the speed.
  double width_of_resonance() const;
  /// Finds the peaks near resonances; where all runs have ended, judges by EN 1991-2.
  void finish(const results::StudyTable& table);
  /// Adds what EN 1991-2 says to the verdicts on limits.
  void add_to(std::vector<results::Verdict>& verdicts) const;
  void record(results::Recorder& recorder) const;
  void print() const;

 private:
  const Scene& scene_;
  const CaseRunner& runner_;
  std::vector<double> frequencies_;  // Hz
  std::vector<results::Resonance> resonances_;
  std::vector<results::Cancellation> cancellations_;
  std::optional<norm::NormCheck> check_;
};

}  // namespace traverse::app
