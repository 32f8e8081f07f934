// Cubic polynomials along a part of an element.
#pragma once

#include <Eigen/Dense>
#include <array>

namespace traverse::beam {

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
