// Points at which the foundation has a nonlinear law: single points, and the integration points of beds.
//
// A bed has four Gauss points per element (and between the breaks of its tables), the number that reproduces the matrix
// of a linear bed, whose integrand is of degree 6. Each point has the stiffness of its part of the length, so that an
// element may lift off in part.
#pragma once

#include <utility>
#include <vector>

#include "beam/assembly.hpp"

namespace traverse::beam {

/// The kind of a sleeper over a gap, in place of a row of foundation_kinds.
inline constexpr std::size_t hanging_sleeper_kind = foundation_kind_count;
/// The kind of a sleeper that slides along x, between the rail and the bridge's running surface or the ground.
inline constexpr std::size_t sliding_sleeper_kind = foundation_kind_count + 1;

struct NonlinearPoint {
  std::size_t kind = 0;  // a row of foundation_kinds, or one of the two kinds above
  Direction direction = Direction::vertical;
  int index = 0;  // in the foundation's list of points of this kind; for a bed the span
  double x = 0.0;
  Station at;
  double k = 0.0, c = 0.0;  // N/m, N s/m, or N m/rad, N m s/rad
  FoundationLaw law;
  int above = -1,
      below = -1;         // hanging sleeper: its unknown and the unknown of the ballast below it (-1: the bridge or the
                          // ground); sliding sleeper: the rail's unknown along x, and -1
  bool on_bridge = true;  // acts on the bridge, at `at`
  Sliding sliding = {};   // replaces the law for a sleeper or a bearing that slides
  double height = 0.0;    // height of a sliding sleeper above the bridge's axis, m
  double depth = 0.0;     // depth of a point of a list below the bridge's axis, m
  double eccentricity = 0.0;  // of a point of a list, m
};

/// The nonlinear points on the elements [first, past) of the bridge: the points of the lists, then the points of beds,
/// element by element.
std::vector<NonlinearPoint> nonlinear_points(const Line& bridge, int first, int past);

/// The parts of an element between the breaks of a bed's tables, which are integrated separately.
std::vector<std::pair<double, double>> bed_pieces(const Bed& bed, const Element& element);

/// The hanging sleepers with columns among [first, past), with their action on the layer below. Their indices count
/// from the left end of the track.
std::vector<NonlinearPoint> hanging_sleepers(const Line& bridge, const Layout& layout, int first, int past);

/// The sliding sleepers, with columns and indices as above.
std::vector<NonlinearPoint> sliding_sleepers(const Line& bridge, const Layout& layout, int first, int past);

/// The displacement at a point as a sum of shape*unknown: the displacement of the beam, or the displacement of a
/// sleeper relative to the layer below.
struct NonlinearShape {
  static constexpr std::size_t most = 8;
  int count = 0;
  std::array<int, most> unknown{-1, -1, -1, -1, -1, -1, -1, -1};  // global
  std::array<double, most> shape{};
};
NonlinearShape shape_of(const Line& bridge, const NonlinearPoint& point);

}  // namespace traverse::beam
