// The peaks of one passage of a train, independent of the solver that computed it.
#pragma once

#include <vector>

#include "base/extremum.hpp"

namespace traverse::base {

/// Magnitudes at a station: m, m/s2, N m, m/s2.
struct ProbePeaks {
  Extreme deflection, acceleration, moment;
  Extreme low_passed{};  // of the acceleration, if it was filtered
};

struct PassagePeaks {
  std::vector<ProbePeaks> peaks;
  double least_wheel_force = 0.0, greatest_wheel_force = 0.0;  // N, of all wheels
  double contact_losses = 0.0, longest_loss = 0.0;             // of all wheels; number, and s to within a step
};

}  // namespace traverse::base
