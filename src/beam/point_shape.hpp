// What a foundation holds at a station, in terms of the unknowns of the element there: the only place where the
// directions of foundations differ, with their beds below.
#pragma once

#include <array>

#include "beam/element.hpp"
#include "beam/line.hpp"

namespace traverse::beam {

/// The unknowns of an element that a direction reaches: four, of the longitudinal one two (-1: none).
std::array<int, 4> unknowns_of(const Line& line, Direction direction, int element);
/// The displacement, or the rotation of the sections, at xi of an element is the sum of shape*unknown.
std::array<double, 4> shape_of(Direction direction, double xi, const Element& element);

/// Both at a station.
struct PointShape {
  std::array<int, 4> unknown{-1, -1, -1, -1};  // global
  std::array<double, 4> shape{};
};
PointShape shape_at(const Line& line, Direction direction, const Station& at);
/// The same of a point of the foundation: at a depth below the axis of a span end the beam moves along x by
/// u + depth*theta.
PointShape shape_at(const Line& line, Direction direction, const Station& at, double depth);

/// Integral of density(x) s s^T over the element, s the shape of a direction: a bed's matrix (eqs. 27, 29, 36 and 38).
Transverse bed_matrix(Direction direction, const Distribution& density, const Element& element);
/// Integral of density(x) s: a bed's resultant as a form of the unknowns.
std::array<double, 4> bed_form(Direction direction, const Distribution& density, const Element& element);

}  // namespace traverse::beam
