// A beam taken apart for its modes: what does not couple is solved by itself, and what is equal only once.
#pragma once

#include <vector>

#include "band.hpp"
#include "beam/beam.hpp"

namespace traverse::modes {

/// Free unknowns of neighbouring nodes that couple, all axial or all transverse: a span of its own, or what lies
/// between two nodes that supports hold altogether.
struct Segment {
  bool axial = false;
  std::vector<int> nodes;     // of the bridge, of each unknown; counted on under a layered track's approaches
  std::vector<int> unknowns;  // of each unknown: its global number
  std::vector<char> slope;    // of each unknown: non-zero for theta, and for what is not the bridge's
  Band K, M;                  // of the same width
  Band D;  // C* - a M - b K*: what the foundation adds to Rayleigh damping. Empty where it was not asked for
  std::vector<std::vector<double>> rigid;  // its rigid motions, one vector each
  std::vector<int> offsets;                // of the nodes, one for each equal segment; the first is 0

  int size() const { return K.size(); }
};

enum class Damping { ignored, included };

/// Collective; the same on every rank. From left to right; equal ones (entries to 1e-9) as one with several offsets.
/// Damping can be included after Beam::set_rayleigh; segments are equal then only with equal damping.
std::vector<Segment> transverse_segments(const beam::Beam& beam, Damping damping = Damping::ignored);
std::vector<Segment> axial_segments(const beam::Beam& beam, Damping damping = Damping::ignored);

}  // namespace traverse::modes
