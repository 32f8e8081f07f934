// From the unknowns of a segment to the nodes of the beam.
#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include "segment.hpp"

namespace traverse::modes {

/// Displacements at all nodes of a mode (real or complex) of the copy of a segment at `offset`, the largest 1; zero
/// where a mode has none at nodes (one element a span: slopes only).
template <class Number>
std::vector<Number> nodal_shape(const Segment& s, int offset, const std::vector<Number>& mode, int nodes) {
  std::vector<Number> shape(static_cast<std::size_t>(nodes), 0.0);
  Number largest = 0.0;
  double slope = 0.0;
  for (std::size_t i = 0; i < mode.size(); ++i) {
    if (s.slope[i] != 0) {
      slope = std::max(slope, std::abs(mode[i]));
      continue;
    }
    shape[static_cast<std::size_t>(s.nodes[i] + offset)] = mode[i];
    if (std::abs(mode[i]) > (1.0 + 1e-9) * std::abs(largest)) largest = mode[i];
  }
  for (Number& v : shape) v = std::abs(largest) > 1e-9 * slope ? v / largest : 0.0;
  return shape;
}

}  // namespace traverse::modes
