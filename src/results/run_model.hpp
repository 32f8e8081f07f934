// How every run of a sweep or a study is computed, as it is stored and printed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "results/recorder.hpp"

namespace traverse::results {

struct RunModel {
  int modes = 0;           // 0: by elements
  int elements = 0;        // of the longest span, or of the rail in a sleeper bay
  bool in_bays = false;    // the latter
  double time_step = 0.0;  // s; 0: exact in time, or chosen for each run
  double accuracy = 0.0;   // from which mesh, step and modes were chosen; 0: they were given
  /// Name and relative error of each peak whose accuracy is promised.
  std::vector<std::pair<std::string, double>> expected_errors{};
  std::string method{};  // of runs side by side, as -ts_type names it; empty: as TS takes it
};

/// As attributes of the group that holds the runs.
std::vector<Attribute> attributes_of(const RunModel& model);
/// "by 3 modes", "by 24 elements a span and steps of 0.00055 s".
std::string method_of(const RunModel& model);
/// The note on runs that have met what no trial run has seen (a 1 for each in `unseen`); "" where there are none.
std::string not_promised(const RunModel& model, const std::vector<double>& unseen);
/// The line about runs that could not stay beside others; "" where there are none.
std::string computed_alone(long runs);

}  // namespace traverse::results
