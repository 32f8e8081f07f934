// Hermite cubics with their derivatives; with shear the element's constant shear strain is added to the rotations at
// both ends (Friedman and Kosmatka 1993).
#include "beam/shape.hpp"

namespace traverse::beam {
namespace {

/// Adds gamma to the coefficients of a displacement, because the slopes at both ends are the rotations plus gamma.
void add_strain(std::array<double, 4>& form, const std::array<double, 4>& gamma) {
  const double slope_sum = form[1] + form[3];
  for (std::size_t i = 0; i < 4; ++i) form[i] += slope_sum * gamma[i];
}

}  // namespace

std::array<double, 4> shear_strain(double h, double shear) {
  const double ratio = shear / (1.0 + shear);
  return {-ratio / h, -0.5 * ratio, ratio / h, -0.5 * ratio};
}

Hermite hermite(double xi, double h, double shear) {
  const double xi2 = xi * xi, xi3 = xi2 * xi;
  const double per_h = 1.0 / h, per_h2 = per_h * per_h, per_h3 = per_h2 * per_h;
  Hermite s{};
  s.value = {1.0 - 3.0 * xi2 + 2.0 * xi3, h * (xi - 2.0 * xi2 + xi3), 3.0 * xi2 - 2.0 * xi3, h * (xi3 - xi2)};
  s.slope = {6.0 * (xi2 - xi) * per_h, 1.0 - 4.0 * xi + 3.0 * xi2, 6.0 * (xi - xi2) * per_h, 3.0 * xi2 - 2.0 * xi};
  s.curvature = {(12.0 * xi - 6.0) * per_h2, (6.0 * xi - 4.0) * per_h, (6.0 - 12.0 * xi) * per_h2,
                 (6.0 * xi - 2.0) * per_h};
  s.third = {12.0 * per_h3, 6.0 * per_h2, -12.0 * per_h3, 6.0 * per_h2};
  if (shear == 0.0) return s;
  const std::array<double, 4> gamma = shear_strain(h, shear);
  for (std::array<double, 4>* form : {&s.value, &s.slope, &s.curvature, &s.third}) add_strain(*form, gamma);
  return s;
}

std::array<double, 4> rotation(double xi, double h, double shear) {
  std::array<double, 4> form = hermite(xi, h, shear).slope;
  if (shear == 0.0) return form;
  const std::array<double, 4> gamma = shear_strain(h, shear);
  for (std::size_t i = 0; i < 4; ++i) form[i] -= gamma[i];
  return form;
}

}  // namespace traverse::beam
