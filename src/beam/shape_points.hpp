// Points along the bridge at which its shapes are stored. They are so close that straight lines between them represent
// the curves of the elements.
#pragma once

#include <cstddef>
#include <vector>

#include "beam/line.hpp"
#include "beam/shape.hpp"

namespace traverse::beam {

class ShapePoints {
 public:
  struct Point {
    double x = 0.0;  // m
    int node = -1;   // -1: inside an element
    Station at;      // station; for a node it is the end of an adjacent element
  };

  /// The nodes, points inside elements of spans with few elements, and the stations `additional`. Ascending.
  explicit ShapePoints(const Mesh& mesh, std::vector<double> additional = {});
  static ShapePoints at_nodes(const Mesh& mesh) { return {mesh, {}, 1}; }

  const std::vector<Point>& points() const { return points_; }
  std::vector<double> x() const;

  /// Slopes in bending of the element's curve, 1/m times the unit of the values; at a hinge the slope on its left.
  template <class Value>
  std::vector<double> slopes(const Line& line, Value value) const {
    std::vector<double> out;
    out.reserve(points_.size());
    for (const Point& p : points_) {
      const auto unknowns = line.transverse(p.at.element);
      const auto psi = hermite(p.at.xi, line.mesh.element(p.at.element).length).slope;
      double sum = 0.0;
      for (std::size_t i = 0; i < 4; ++i) sum += psi[i] * value(unknowns[i]);
      out.push_back(sum);
    }
    return out;
  }

  /// The element's curve through nodal values, cubic in bending and linear along x. value(unknown) is the value of a
  /// global unknown of the line.
  template <class Number, class Value>
  std::vector<Number> curve(const Line& line, bool axial, Value value) const {
    std::vector<Number> out;
    out.reserve(points_.size());
    for (const Point& p : points_) {
      Number sum = 0.0;
      if (p.node >= 0) {
        const int unknown = line.unknown(p.node, axial ? 0 : 1);
        sum = unknown < 0 ? Number(0.0) : value(unknown);
      } else if (axial) {
        const auto unknowns = line.axial(p.at.element);
        const auto phi = linear(p.at.xi);
        for (std::size_t i = 0; i < 2; ++i) sum += phi[i] * value(unknowns[i]);
      } else {
        const auto unknowns = line.transverse(p.at.element);
        const Element& element = line.mesh.element(p.at.element);
        const auto psi = hermite(p.at.xi, element.length, element.shear).value;
        for (std::size_t i = 0; i < 4; ++i) sum += psi[i] * value(unknowns[i]);
      }
      out.push_back(sum);
    }
    return out;
  }

 private:
  ShapePoints(const Mesh& mesh, std::vector<double> additional, int points_per_span);

  std::vector<Point> points_;
};

}  // namespace traverse::beam
