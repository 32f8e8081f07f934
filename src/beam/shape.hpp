// Shape functions of the beam element, eqs. 4 and 5 of the paper, and of the Timoshenko element.
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

}  // namespace traverse::beam
