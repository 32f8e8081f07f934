// Division of a beam for its modes: uncoupled segments are solved separately, and equal segments only once. Their
// unknowns are converted to the stored shape of the bridge.
#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include "band.hpp"
#include "beam/beam.hpp"
#include "beam/shape.hpp"
#include "modes/modes.hpp"

namespace traverse::modes {

/// Coupled free unknowns of neighbouring nodes, all of one motion: the unknowns of a separate span, or the unknowns
/// between two completely held nodes.
struct Segment {
  Motion motion = Motion::bending;
  std::vector<int>
      nodes;  // node of the bridge for each unknown; the numbers continue on the approaches of a layered track
  std::vector<int> unknowns;  // global number of each unknown
  std::vector<char> slope;    // for each unknown: 0 for v of the bridge (u or the twist alone), otherwise non-zero
  Band K, M;                  // both have the same width
  Band D;  // C* - a M - b K*: the foundation's contribution besides Rayleigh damping; empty if damping is ignored
  std::vector<std::vector<double>> rigid;  // rigid motions, one vector each
  std::vector<int> offsets;                // offset of the nodes for each equal segment; the first is 0

  int size() const { return K.size(); }
  /// The order of its frequencies with the number of elements: squared, they grow with this power.
  double order() const { return motion == Motion::along || motion == Motion::twist ? 2.0 : 4.0; }
};

enum class Damping { ignored, included };

/// Collective; every rank gets the same segments, from left to right. Equal segments (entries to 1e-9) are one segment
/// with several offsets. Damping can be included after Beam::set_rayleigh; equal segments then have equal damping too.
/// `all`: of all motions; otherwise of the motions that loads across the beam cause.
std::vector<Segment> segments_of(const beam::Beam& beam, bool all, Damping damping = Damping::ignored);
/// Of bending, with a twist that is held.
std::vector<Segment> bending_segments(const beam::Beam& beam);

/// Collective. The segment's rows and columns of a matrix of the beam, on every rank; zero if there is no matrix.
Band part_of(Mat matrix, const Segment& segment);

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
  std::vector<Number> shape = points.curve<Number>(beam.bridge(),
                                                   s.motion == Motion::along   ? beam::Along::axis
                                                   : s.motion == Motion::twist ? beam::Along::twist
                                                                               : beam::Along::deflection,
                                                   [&](int unknown) { return all[static_cast<std::size_t>(unknown)]; });
  scale_to_one(shape, 1e-9 * slope);
  return shape;
}

}  // namespace traverse::modes
