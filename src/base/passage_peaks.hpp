// The peaks of one run of a train over the bridge, independent of the solver that computed it.
#pragma once

#include <string>
#include <vector>

#include "base/extremum.hpp"

namespace traverse::base {

/// The peaks at a station, magnitudes: m, m/s2, N m, m/s2.
struct ProbePeaks {
  Extreme deflection, acceleration, moment;
  Extreme low_passed{};  // peak of the low-passed acceleration, if it was filtered
};

/// The largest magnitudes of a mass damper's travel, m, and of its force on the beam, N.
struct DamperPeaks {
  std::string name;
  Extreme travel, force;
};

struct PassagePeaks {
  std::vector<ProbePeaks> peaks;
  double least_wheel_force = 0.0, greatest_wheel_force = 0.0;  // least and greatest force of all wheels, N
  double contact_losses = 0.0,
         longest_loss = 0.0;  // all wheels: number of losses; longest duration, s, with an error of up to one time step
};

}  // namespace traverse::base
