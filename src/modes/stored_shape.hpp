// Conversion of the unknowns of a segment to the stored shape of the bridge.
#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include "beam/shape.hpp"
#include "segment.hpp"

namespace traverse::modes {

/// Divides all values by the one of largest magnitude; they become 0 if its magnitude is not above `rounding`.
template <class Number>
void scale_to_one(std::vector<Number>& shape, double rounding) {
  Number largest = 0.0;
  for (const Number& v : shape)
    if (std::abs(v) > (1.0 + 1e-9) * std::abs(largest)) largest = v;
  for (Number& v : shape) v = std::abs(largest) > rounding ? v / largest : 0.0;
}

/// The displacements of a mode (real or complex) at the points, for the copy of a segment at `offset`, with the largest
/// value 1. They are zero if the mode has none there (nodes, with one element per span: slopes only).
template <class Number>
std::vector<Number> stored_shape(const beam::Beam& beam, const Segment& s, int offset, const std::vector<Number>& mode,
                                 const beam::ShapePoints& points) {
  std::vector<Number> all(static_cast<std::size_t>(beam.columns()) * static_cast<std::size_t>(beam.block()), 0.0);
  double slope = 0.0;
  for (std::size_t i = 0; i < mode.size(); ++i) {
    all[static_cast<std::size_t>(s.unknowns[i] + offset * beam.block())] = mode[i];
    if (s.slope[i] != 0) slope = std::max(slope, std::abs(mode[i]));
  }
  std::vector<Number> shape =
      points.curve<Number>(beam.bridge(), s.axial, [&](int unknown) { return all[static_cast<std::size_t>(unknown)]; });
  scale_to_one(shape, 1e-9 * slope);
  return shape;
}

}  // namespace traverse::modes
