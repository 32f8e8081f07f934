// Division of a beam for its modes: uncoupled segments are solved separately, and equal segments only once.
#pragma once

#include <vector>

#include "band.hpp"
#include "beam/beam.hpp"

namespace traverse::modes {

/// Coupled free unknowns of neighbouring nodes, all axial or all transverse: the unknowns of a separate span, or the
/// unknowns between two completely held nodes.
struct Segment {
  bool axial = false;
  std::vector<int>
      nodes;  // node of the bridge for each unknown; the numbers continue on the approaches of a layered track
  std::vector<int> unknowns;  // global number of each unknown
  std::vector<char> slope;    // for each unknown: 0 for v of the bridge (u in an axial segment), otherwise non-zero
  Band K, M;                  // both have the same width
  Band D;  // C* - a M - b K*: the foundation's contribution besides Rayleigh damping; empty if damping is ignored
  std::vector<std::vector<double>> rigid;  // rigid motions, one vector each
  std::vector<int> offsets;                // offset of the nodes for each equal segment; the first is 0

  int size() const { return K.size(); }
};

enum class Damping { ignored, included };

/// Collective; every rank gets the same segments, from left to right. Equal segments (entries to 1e-9) are one segment
/// with several offsets. Damping can be included after Beam::set_rayleigh; equal segments then have equal damping too.
std::vector<Segment> transverse_segments(const beam::Beam& beam, Damping damping = Damping::ignored);
std::vector<Segment> axial_segments(const beam::Beam& beam, Damping damping = Damping::ignored);

/// Collective. The segment's rows and columns of a matrix of the beam, on every rank; zero if there is no matrix.
Band part_of(Mat matrix, const Segment& segment);

}  // namespace traverse::modes
