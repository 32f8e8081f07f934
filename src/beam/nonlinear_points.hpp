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

struct NonlinearPoint {
  std::size_t kind = 0;  // a row of foundation_kinds
  Direction direction = Direction::vertical;
  int index = 0;  // in the foundation's list of points of this kind; of a bed its span
  double x = 0.0;
  Station at;
  double k = 0.0, c = 0.0;  // N/m, N s/m, or N m/rad, N m s/rad
  FoundationLaw law;
};

/// Those on the elements [first, past) of the bridge: the points of the lists, then the beds, element by element.
std::vector<NonlinearPoint> nonlinear_points(const Line& bridge, int first, int past);

/// The pieces of an element between whose ends a bed's tables have no break, each integrated by itself.
std::vector<std::pair<double, double>> bed_pieces(const Bed& bed, const Element& element);

/// That of the displacement at a point.
PointShape shape_of(const Line& bridge, const NonlinearPoint& point);

}  // namespace traverse::beam
