// The lowest modes of one segment by SLEPc: shift and invert, next to the lowest frequency.
#pragma once

#include <vector>

#include "segment.hpp"

namespace traverse::modes {

struct Eigenpair {
  double omega = 0.0;         // rad/s
  std::vector<double> shape;  // of each unknown of the segment
};

/// The `count` lowest modes of the segment, rigid ones included, ascending, all copies of a repeated frequency.
/// Needs nothing from other ranks, and gives the same bits on each. Throws SolverError.
std::vector<Eigenpair> lowest_modes(const Segment& segment, int count);

}  // namespace traverse::modes
