// Shape functions of the beam element, eqs. 4 and 5 of the paper, and of the Timoshenko element, the points along the
// bridge at which its shapes are stored, and cubic polynomials along a part of an element.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <vector>

#include "beam/line.hpp"

namespace traverse::beam {

/// Transverse shape functions psi_1..psi_4 (v1, theta1, v2, theta2) and their derivatives with respect to x
/// at x = xi*h inside an element of length h, 0 <= xi <= 1.
struct Hermite {
  std::array<double, 4> value;      // psi
  std::array<double, 4> slope;      // d psi/dx, 1/m
  std::array<double, 4> curvature;  // d2 psi/dx2, 1/m2
  std::array<double, 4> third;      // d3 psi/dx3, 1/m3
};
/// shear: 12 EI/(GA h^2). Without loads inside the element v' = theta + gamma with a constant gamma, and v remains
/// cubic: exact for constant EI and GA, without locking (Friedman and Kosmatka 1993). 0: Bernoulli-Euler.
Hermite hermite(double xi, double h, double shear = 0.0);

/// The coefficients of (v1, theta1, v2, theta2) in the shear strain gamma = v' - theta of an element.
std::array<double, 4> shear_strain(double h, double shear);

/// The coefficients of (v1, theta1, v2, theta2) in the rotation theta of the sections: the slope minus the shear
/// strain.
std::array<double, 4> rotation(double xi, double h, double shear);

/// Axial shape functions phi_1, phi_2.
inline std::array<double, 2> linear(double xi) { return {1.0 - xi, xi}; }

/// A curve along the beam.
enum class Along { axis, deflection, twist };

/// Points along the bridge at which its shapes are stored. They are so close that straight lines between them represent
/// the curves of the elements.
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

  /// The element's curve through nodal values, cubic in bending and twist, linear along x. value(unknown) is the value
  /// of a global unknown of the line.
  template <class Number, class Value>
  std::vector<Number> curve(const Line& line, Along which, Value value) const {
    std::vector<Number> out;
    out.reserve(points_.size());
    for (const Point& p : points_) {
      Number sum = 0.0;
      if (p.node >= 0) {
        const int unknown = line.unknown(p.node, which == Along::axis ? 0 : which == Along::twist ? 5 : 1);
        sum = unknown < 0 ? Number(0.0) : value(unknown);
      } else if (which == Along::axis) {
        const auto unknowns = line.axial(p.at.element);
        const auto phi = linear(p.at.xi);
        for (std::size_t i = 0; i < 2; ++i) sum += phi[i] * value(unknowns[i]);
      } else {
        const bool bends = which == Along::deflection;
        const auto unknowns = bends ? line.transverse(p.at.element) : line.twists(p.at.element);
        const Element& element = line.mesh.element(p.at.element);
        const auto psi = hermite(p.at.xi, element.length, bends ? element.shear : 0.0).value;
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

using Cubic = std::array<double, 4>;  // coefficients of the powers

/// The deflection of an element of length h from its nodal values (v1, theta1, v2, theta2), with shear as in shape.hpp.
inline Cubic hermite_cubic(const std::array<double, 4>& end, double h, double shear) {
  const double rise = (end[2] - end[0]) / h;
  const double gamma = shear / (1.0 + shear) * (rise - 0.5 * (end[1] + end[3]));
  const double left = end[1] + gamma, right = end[3] + gamma;
  return {end[0], left, (3.0 * rise - 2.0 * left - right) / h, (left + right - 2.0 * rise) / (h * h)};
}

/// The cubic through four points inside a part of length h, at whose ends the response may jump.
template <class Response>
Cubic cubic_through(double h, Response response) {
  Eigen::Matrix4d powers;
  Eigen::Vector4d values;
  for (int i = 0; i < 4; ++i) {
    const double xi = (2.0 * i + 1.0) / 8.0;
    powers.row(i) << 1.0, xi, xi * xi, xi * xi * xi;
    values[i] = response(xi * h);
  }
  const Eigen::Vector4d c = powers.partialPivLu().solve(values);
  return {c[0], c[1] / h, c[2] / (h * h), c[3] / (h * h * h)};
}

/// The polynomial c in powers of x, rewritten in powers of x - d.
inline Cubic shifted(const Cubic& c, double d) {
  return {c[0] + d * (c[1] + d * (c[2] + d * c[3])), c[1] + d * (2.0 * c[2] + 3.0 * d * c[3]), c[2] + 3.0 * d * c[3],
          c[3]};
}

}  // namespace traverse::beam
