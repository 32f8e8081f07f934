// Counts the steps of a run before it, from the times at which steps have to end.
#pragma once

#include <vector>

namespace traverse::integrate {

struct StepCount {
  double steps = 0.0;
  double lengths = 0.0;  // lengths of steps for which the beam's matrix has to be factored, also again
};

/// Steps of at most `longest` from 0 to `end` that end at every multiple of `interval` and at `stops` (ascending), all
/// in s: between two ends they are equal, as in Stepper::run. The factorisations for the last `stored` lengths are
/// kept.
StepCount count_steps(double end, double interval, double longest, const std::vector<double>& stops,
                      std::size_t stored);

}  // namespace traverse::integrate
