// Element matrices of the beam, eqs. 4-11 of the paper, with shear and rotary inertia if the model has them, nodal
// forces of loads and strains along an element, and Gauss integration along it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "base/gauss.hpp"
#include "beam/mesh.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// The value of `d` between a and b if it is constant there.
inline std::optional<double> constant_value(const Distribution& d, double a, double b) {
  if (d.uniform()) return d.at(a, b);
  const double value = d.at(a, b);
  if (d.at(b, a) != value) return {};
  for (double x : d.breaks(a, b)) {
    if (d.at(x, a) != value || d.at(x, b) != value) return {};
  }
  return value;
}

/// Calls sum(x, weight*d(x)) for a Gauss rule on [from, to], divided at the breaks of `d`, with four points between
/// breaks. It is exact for d(x) times a polynomial of degree 6.
template <class Sum>
void integrate(const Distribution& d, double from, double to, Sum sum) {
  auto ends = d.breaks(from, to);
  ends.push_back(to);
  double left = from;
  for (double right : ends) {
    const double middle = 0.5 * (left + right);
    base::at_gauss_points<4>(left, right, [&](double x, double weight) { sum(x, weight * d.at(x, middle)); });
    left = right;
  }
}

/// Row-major; the axial unknowns of an element are (u1, u2), the transverse ones (v1, theta1, v2, theta2).
using Axial = std::array<double, 4>;        // 2 x 2
using Transverse = std::array<double, 16>;  // 4 x 4

/// Eqs. 8 and 9, without foundation. kg, kg m, kg m2 and N/m, N, N m.
struct ElementMatrices {
  Axial axial_mass{}, axial_stiffness{};  // the stiffness is zero if the model has no axial unknowns
  Transverse mass{}, stiffness{};
};
/// In closed form if EI, EA and mass are constant over the element; otherwise by Gauss integration between the breaks
/// of their tables, which is exact for piecewise linear data.
ElementMatrices element_matrices(const BeamModel& model, const Element& element);

/// Integral of density(x) psi psi^T over the element: the mass matrix, a vertical bed (eqs. 27 and 29).
Transverse transverse_bed(const Distribution& density, const Element& element);
/// Integral of density(x) phi phi^T: the axial mass matrix, a longitudinal bed (eqs. 36 and 38).
Axial axial_bed(const Distribution& density, const Element& element);
/// Integral of density(x) theta theta^T, theta the shapes of the rotation (psi' without shear): rotary inertia, or a
/// bed that resists the rotation.
Transverse slope_bed(const Distribution& density, const Element& element);
/// The matrices of (twist1, rate1, twist2, rate2), for a cubic twist: N m and kg m2 for the twists. `coupling` is the
/// mass between the transverse unknowns (rows) and these, kg m for a deflection and a twist.
struct TorsionMatrices {
  Transverse stiffness{}, mass{}, coupling{};
};
TorsionMatrices torsion_matrices(const BeamModel& model, const Element& element);

/// Integral of density(x) psi: nodal forces of a distributed force (eq. 10).
std::array<double, 4> transverse_load(const Distribution& density, const Element& element);
/// Integral of density(x) phi: nodal forces of a distributed force along x.
std::array<double, 2> axial_load(const Distribution& density, const Element& element);
/// Integral of density(x) theta: nodal forces of a distributed moment.
std::array<double, 4> slope_load(const Distribution& density, const Element& element);

/// Nodal forces of the bridge's temperature: the forces of an element on its nodes if these are held. They are in
/// equilibrium.
std::array<double, 4> strain_load(const BeamModel& model, const Element& element);
std::array<double, 2> axial_strain_load(const BeamModel& model, const Element& element);

/// c s s^T, the matrix of a spring or damper c at one station with the shape vector s.
template <std::size_t N>
std::array<double, N * N> outer(double c, const std::array<double, N>& s) {
  std::array<double, N * N> matrix{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) matrix[i * N + j] = c * s[i] * s[j];
  }
  return matrix;
}

}  // namespace traverse::beam
