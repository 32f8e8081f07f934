// Points along the bridge at which its shapes are stored: close enough together that straight lines from one to the
// next look like the curves that the elements have.
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
    Station at;      // of a node: an element that ends there
  };

  /// The nodes, points inside elements where a span has few of them, and `also`: stations on the bridge. Ascending.
  explicit ShapePoints(const Mesh& mesh, std::vector<double> also = {});
  static ShapePoints at_nodes(const Mesh& mesh) { return {mesh, {}, 1}; }

  const std::vector<Point>& points() const { return points_; }
  std::vector<double> x() const;

  /// Slopes of the elements' own curve in bending, 1/m times the values' unit; at a hinge that on its left.
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

  /// The elements' own curve through nodal values, cubic in bending and linear along x. value(unknown): of a global
  /// unknown of the line.
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
  ShapePoints(const Mesh& mesh, std::vector<double> also, int points_a_span);

  std::vector<Point> points_;
};

}  // namespace traverse::beam
