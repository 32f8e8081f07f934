// The lowest modes of one segment by SLEPc, with shift and invert next to the lowest frequency.
#pragma once

#include <vector>

#include "segment.hpp"

namespace traverse::modes {

struct Eigenpair {
  double omega = 0.0;         // rad/s
  std::vector<double> shape;  // for each unknown of the segment
};

/// The `count` lowest modes of the segment, including rigid ones, ascending, with all copies of a repeated frequency.
/// Needs no communication and has the same bits on each rank. Throws SolverError.
std::vector<Eigenpair> lowest_modes(const Segment& segment, int count);

}  // namespace traverse::modes
