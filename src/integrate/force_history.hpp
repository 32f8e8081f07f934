// The effect of moving forces on a bridge over the distance that they have travelled, which is the same at every speed.
#pragma once

#include <vector>

#include "structure/modal_bridge.hpp"
#include "traverse/train/vehicle.hpp"

namespace traverse::integrate {

/// Sums of the influence of all forces: cubic polynomials of the distance, between the distances at which a force
/// passes a break. The last interval has no end. The first one has the forces that are on the bridge at the start; it
/// has no length if others arrive at once.
struct ForceHistory {
  /// InputError if it does not fit into memory.
  ForceHistory(const structure::PiecewiseCubic& influence, const train::MovingLoad& load);

  std::vector<double> start;  // start of each interval, m travelled since t = 0; the first is 0
  std::size_t channels = 0;
  std::vector<double> coefficients;  // [interval][power][channel] of the distance since the interval's start

  const double* interval(std::size_t i) const { return &coefficients[4 * channels * i]; }
};

}  // namespace traverse::integrate
