// The displacement that a foundation resists at a station, as a linear combination of the element's unknowns. Only this
// file and the functions of beds below distinguish the directions of foundations.
#pragma once

#include <array>

#include "beam/element.hpp"
#include "beam/line.hpp"

namespace traverse::beam {

/// The unknowns of an element for a direction: four, or two for the longitudinal direction (-1: none).
std::array<int, 4> unknowns_of(const Line& line, Direction direction, int element);
/// The displacement, or the rotation of the sections, at xi of an element as the sum of shape*unknown.
std::array<double, 4> shape_of(Direction direction, double xi, const Element& element);

/// Unknowns and shapes at a station.
struct PointShape {
  std::array<int, 4> unknown{-1, -1, -1, -1};  // global
  std::array<double, 4> shape{};
};
PointShape shape_at(const Line& line, Direction direction, const Station& at);
/// Unknowns and shapes at a point of the foundation. At a depth below the axis of a span end the displacement along x
/// is u + depth*theta.
PointShape shape_at(const Line& line, Direction direction, const Station& at, double depth);

/// Integral of density(x) s s^T over the element, s the shape of a direction: the matrix of a bed (eqs. 27, 29, 36,
/// 38).
Transverse bed_matrix(Direction direction, const Distribution& density, const Element& element);
/// Integral of density(x) s: the coefficients of the unknowns in the resultant of a bed.
std::array<double, 4> bed_form(Direction direction, const Distribution& density, const Element& element);

}  // namespace traverse::beam
