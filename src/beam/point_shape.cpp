// Shape functions (equations 4 and 5 of the paper) and unknowns of an element for foundations in the vertical,
// longitudinal and rotational direction.
#include "beam/point_shape.hpp"

#include "beam/shape.hpp"

namespace traverse::beam {
namespace {

/// A matrix of u1, u2 as a matrix of four unknowns.
Transverse among_four(const Axial& m) { return {m[0], m[1], 0.0, 0.0, m[2], m[3]}; }

}  // namespace

std::array<int, 4> unknowns_of(const Line& line, Direction direction, int element) {
  if (direction != Direction::longitudinal) return line.transverse(element);
  const auto [u1, u2] = line.axial(element);
  return {u1, u2, -1, -1};
}

std::array<double, 4> shape_of(Direction direction, double xi, const Element& element) {
  if (direction == Direction::vertical) return hermite(xi, element.length, element.shear).value;
  if (direction == Direction::rotational) return rotation(xi, element.length, element.shear);
  const auto [left, right] = linear(xi);
  return {left, right, 0.0, 0.0};
}

PointShape shape_at(const Line& line, Direction direction, const Station& at) {
  return {unknowns_of(line, direction, at.element), shape_of(direction, at.xi, line.mesh.element(at.element))};
}

PointShape shape_at(const Line& line, Direction direction, const Station& at, double depth) {
  if (depth == 0.0) return shape_at(line, direction, at);
  const std::size_t end = at.xi < 0.5 ? 0 : 1;
  return {{line.axial(at.element)[end], line.transverse(at.element)[2 * end + 1], -1, -1}, {1.0, depth, 0.0, 0.0}};
}

Transverse bed_matrix(Direction direction, const Distribution& density, const Element& element) {
  if (direction == Direction::vertical) return transverse_bed(density, element);
  if (direction == Direction::rotational) return slope_bed(density, element);
  return among_four(axial_bed(density, element));
}

std::array<double, 4> bed_form(Direction direction, const Distribution& density, const Element& element) {
  if (direction == Direction::vertical) return transverse_load(density, element);
  if (direction == Direction::rotational) return slope_load(density, element);
  const auto [left, right] = axial_load(density, element);
  return {left, right, 0.0, 0.0};
}

}  // namespace traverse::beam
