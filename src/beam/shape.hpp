// Shape functions of the beam element, the paper's eqs. 4 and 5.
#pragma once

#include <array>

namespace traverse::beam {

/// Transverse shape functions psi_1..psi_4 (v1, theta1, v2, theta2) and their derivatives with respect to x
/// at x = xi*h inside an element of length h, 0 <= xi <= 1.
struct Hermite {
  std::array<double, 4> value;      // psi
  std::array<double, 4> slope;      // d psi/dx, 1/m
  std::array<double, 4> curvature;  // d2 psi/dx2, 1/m2
  std::array<double, 4> third;      // d3 psi/dx3, 1/m3
};
Hermite hermite(double xi, double h);

/// Axial shape functions phi_1, phi_2.
inline std::array<double, 2> linear(double xi) { return {1.0 - xi, xi}; }

}  // namespace traverse::beam
