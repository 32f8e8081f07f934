// Estimates the cost of a scene by counting and by measured times of other runs.
#pragma once

#include <string>
#include <vector>

#include "first_run.hpp"

namespace traverse::check {

struct Cost {
  double unknowns = 0.0;       // unknowns of the structure and the vehicles
  double steps = 0.0;          // steps of a run, with the first step of its trial runs
  double seconds = 0.0;        // s, for all runs, on one processor
  double trial_seconds = 0.0;  // s, for the trial runs
  double memory = 0.0;         // bytes
  double stored = 0.0;         // bytes of the results file
  std::string faster_way;      // a much faster way, in words; empty: none
};

Cost cost_of(const FirstRun& run);

/// "12 MB".
std::string bytes_text(double bytes);

}  // namespace traverse::check
