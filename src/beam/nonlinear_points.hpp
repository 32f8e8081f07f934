// Where the foundation acts by a law that is not linear: its points, and the points of integration of its beds.
//
// A bed is integrated with four Gauss points an element (and between the breaks of its tables): the number that
// reproduces the matrix of a linear bed, whose integrand is of degree 6. Each point obeys the law with the stiffness
// of the length that it stands for, so that an element may have lifted off in part.
#pragma once

#include <utility>
#include <vector>

#include "beam/point_shape.hpp"

namespace traverse::beam {

/// Instead of a row of foundation_kinds: a sleeper over a gap.
inline constexpr std::size_t below_a_sleeper = foundation_kind_count;
/// The same: a sleeper that slides along x, between the rail and the bridge's running surface or the ground.
inline constexpr std::size_t along_a_sleeper = foundation_kind_count + 1;

struct NonlinearPoint {
  std::size_t kind = 0;  // a row of foundation_kinds, or below_a_sleeper
  Direction direction = Direction::vertical;
  int index = 0;  // in the foundation's list of points of this kind; of a bed its span
  double x = 0.0;
  Station at;
  double k = 0.0, c = 0.0;  // N/m, N s/m, or N m/rad, N m s/rad
  FoundationLaw law;
  int above = -1,
      below = -1;         // of a sleeper: its unknown, and that of the ballast below it; -1: the bridge or the ground;
                          // of one that slides: the rail's along x, and none
  bool on_bridge = true;  // it acts on the bridge, at `at`
  Sliding sliding = {};   // of a sleeper or a bearing that slides, instead of the law
  double height = 0.0;    // m above the bridge's axis, at which a sleeper slides along x
  double depth = 0.0;     // m below it, of a point of a list
};

/// Those on the elements [first, past) of the bridge: the points of the lists, then the beds, element by element.
std::vector<NonlinearPoint> nonlinear_points(const Line& bridge, int first, int past);

/// The pieces of an element between whose ends a bed's tables have no break, each integrated by itself.
std::vector<std::pair<double, double>> bed_pieces(const Bed& bed, const Element& element);

/// The sleepers over a gap whose columns are among [first, past): what they do to the layer below. Their numbers count
/// from the left end of the track.
std::vector<NonlinearPoint> hanging_sleepers(const Line& bridge, const Layout& layout, int first, int past);

/// The sleepers that slide along x, likewise.
std::vector<NonlinearPoint> sliding_sleepers(const Line& bridge, const Layout& layout, int first, int past);

/// The displacement at a point as a sum of shape*unknown: of the beam, or of a sleeper less what lies below it.
struct NonlinearShape {
  static constexpr std::size_t most = 7;
  int count = 0;
  std::array<int, most> unknown{-1, -1, -1, -1, -1, -1, -1};  // global
  std::array<double, most> shape{};
};
NonlinearShape shape_of(const Line& bridge, const NonlinearPoint& point);

}  // namespace traverse::beam
