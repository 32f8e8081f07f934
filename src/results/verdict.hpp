// What a run says of the limits that the user has set.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "traverse/options/verdict_limit.hpp"

namespace traverse::results {

/// The greatest value that a run has seen of a quantity, or why there is none.
struct Finding {
  double value = std::numeric_limits<double>::quiet_NaN();  // a magnitude
  double time = std::numeric_limits<double>::quiet_NaN();   // s
  std::string place;                                        // "x = 12.5 m", "vehicle 3, rear_wheel"
  std::string why;                                          // it is not known; empty: it is
};

struct Verdict {
  options::VerdictLimit limit;
  std::string unit;
  Finding found;

  bool judged() const { return found.why.empty(); }
  bool kept() const { return found.value <= limit.value; }
  /// What is left to the limit, over it: below 0 where it is broken.
  double margin() const { return 1.0 - found.value / limit.value; }
  /// "kept", "broken" or "not judged".
  std::string word() const;
};

/// One line each.
void print_verdicts(const std::vector<Verdict>& verdicts);

/// Into /verdicts of the file.
void record_verdicts(Recorder& recorder, const std::vector<Verdict>& verdicts);

}  // namespace traverse::results
