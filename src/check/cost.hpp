// What a scene will take, estimated by counting and by what was measured on other runs.
#pragma once

#include <string>
#include <vector>

#include "look.hpp"

namespace traverse::app {

struct Cost {
  double unknowns = 0.0;  // of the structure and the vehicles
  double steps = 0.0;     // of a run, as its trial runs begin
  double seconds = 0.0;   // of all runs, on one processor
  double trials = 0.0;    // s, of the trial runs before
  double memory = 0.0;    // bytes
  double stored = 0.0;    // bytes of the results file
  std::string quicker;    // what may make it much quicker, in words; empty: nothing
};

Cost cost_of(const Look& look);

/// "12 MB".
std::string bytes_text(double bytes);

}  // namespace traverse::app
