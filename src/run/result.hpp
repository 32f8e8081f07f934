// The result of a run, as values.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/passage_peaks.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "run/response_extremes.hpp"

namespace traverse::run {

struct Result {
  /// The magnitudes of the peaks at each probe, and the extremes of all wheels.
  base::PassagePeaks passage_peaks() const;

  ResponseExtremes peaks;                        // of each quantity at every probe and wheel
  results::Summary summary;                      // greatest values; energies, residuals and cost of the run
  std::vector<results::Separation> separations;  // losses of contact
  bool lost_contact = false;                     // one of any contact that was closed at the start
  std::vector<results::Verdict> verdicts;        // on the scene's limits, if they were wanted
  bool filter_unsettled = false;                 // the low-passed peak is within the unsettled end of the filter
  // What is stored once, if it was wanted.
  std::vector<results::Recorder::Dataset> datasets;
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>> tables;
  std::optional<results::Shape> shape;

  /// Writes what is stored once.
  void record(results::Recorder& recorder) const;
};

}  // namespace traverse::run
