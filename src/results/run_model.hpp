// The model of all runs of a sweep or a study, as stored and printed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "results/recorder.hpp"

namespace traverse::results {

struct RunModel {
  int modes = 0;           // 0: by elements
  int elements = 0;        // elements in the longest span, or rail elements in a sleeper bay
  bool in_bays = false;    // `elements` is the number in a sleeper bay
  double time_step = 0.0;  // s; 0: exact in time, or chosen for each run
  double accuracy = 0.0;   // accuracy for which mesh, step and modes were chosen; 0: they were given
  /// Name and relative error of each peak with an error estimate.
  std::vector<std::pair<std::string, double>> expected_errors{};
  std::string method{};  // method of batched runs, as in -ts_type; empty: PETSc's default
};

/// Attributes of the group of the runs.
std::vector<Attribute> attributes_of(const RunModel& model);
/// "by 3 modes", "by 24 elements a span and steps of 0.00055 s".
std::string method_of(const RunModel& model);
/// The note on runs with events that no trial run covered (a 1 for each in `outside_trials`); "" if there are none.
std::string extrapolation_note(const RunModel& model, const std::vector<double>& outside_trials);
/// The line about runs that were computed outside their batch; "" if there are none.
std::string separate_runs_note(long runs);

}  // namespace traverse::results
