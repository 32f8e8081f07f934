// Section forces by equilibrium of the part of the element left of the section, and the deflection of an element
// clamped at both ends under a point force or moment.
#include "section.hpp"

#include "beam/shape.hpp"
#include "gauss.hpp"

namespace traverse::beam {

void SectionForms::add_end_forces(const Transverse& matrix) {
  const double x = xi_ * element_.length;
  for (std::size_t j = 0; j < 4; ++j) {
    shear_[j] += matrix[j];
    moment_[j] += x * matrix[j] - matrix[4 + j];
  }
}

void SectionForms::add_end_forces(const Axial& matrix) {
  for (std::size_t j = 0; j < 2; ++j) axial_force_[j] -= matrix[j];
}

void SectionForms::add_transverse_density(const Distribution& density) {
  const double h = element_.length, section = element_.x + xi_ * h;
  integrate(density, element_.x, section, [&](double x, double weight) {
    const auto psi = hermite((x - element_.x) / h, h, element_.shear).value;
    for (std::size_t j = 0; j < 4; ++j) {
      shear_[j] -= weight * psi[j];
      moment_[j] -= weight * psi[j] * (section - x);
    }
  });
}

void SectionForms::add_axial_density(const Distribution& density) {
  const double h = element_.length;
  integrate(density, element_.x, element_.x + xi_ * h, [&](double x, double weight) {
    const auto phi = linear((x - element_.x) / h);
    for (std::size_t j = 0; j < 2; ++j) axial_force_[j] += weight * phi[j];
  });
}

void SectionForms::add_vertical_spring(double c, double xi) {
  const auto psi = hermite(xi, element_.length, element_.shear).value;
  add_end_forces(outer(c, psi));
  if (!is_left(xi, xi_)) return;
  for (std::size_t j = 0; j < 4; ++j) {
    shear_[j] -= c * psi[j];
    moment_[j] -= c * psi[j] * (xi_ - xi) * element_.length;
  }
}

void SectionForms::add_rotational_spring(double c, double xi) {
  const auto theta = rotation(xi, element_.length, element_.shear);
  add_end_forces(outer(c, theta));
  if (!is_left(xi, xi_)) return;
  for (std::size_t j = 0; j < 4; ++j) moment_[j] += c * theta[j];
}

void SectionForms::add_longitudinal_spring(double c, double xi) {
  const auto phi = linear(xi);
  add_end_forces(outer(c, phi));
  if (!is_left(xi, xi_)) return;
  for (std::size_t j = 0; j < 2; ++j) axial_force_[j] += c * phi[j];
}

void SectionForms::add_rotational_density(const Distribution& density) {
  const double h = element_.length;
  integrate(density, element_.x, element_.x + xi_ * h, [&](double x, double weight) {
    const auto theta = rotation((x - element_.x) / h, h, element_.shear);
    for (std::size_t j = 0; j < 4; ++j) moment_[j] += weight * theta[j];
  });
}

void SectionForms::add_bed(Direction direction, const Distribution& density) {
  switch (direction) {
    case Direction::vertical:
      add_end_forces(transverse_bed(density, element_));
      return add_transverse_density(density);
    case Direction::longitudinal:
      add_end_forces(axial_bed(density, element_));
      return add_axial_density(density);
    case Direction::rotational:
      add_end_forces(slope_bed(density, element_));
      return add_rotational_density(density);
  }
}

void SectionForms::add_spring(Direction direction, double c, double xi) {
  switch (direction) {
    case Direction::vertical:
      return add_vertical_spring(c, xi);
    case Direction::longitudinal:
      return add_longitudinal_spring(c, xi);
    case Direction::rotational:
      return add_rotational_spring(c, xi);
  }
}

double clamped_timoshenko_response(double xi, double load, double shear, bool rotated, bool moment) {
  // From the left end on: zero up to the load; behind it w'' = M and w' = theta - V shear/12.
  struct Shape {
    double value, theta;
  };
  const auto response_behind = [&](double d) -> Shape {
    if (d <= 0.0) return {0.0, 0.0};
    return moment ? Shape{-0.5 * d * d, -d} : Shape{d * (d * d / 6.0 - shear / 12.0), 0.5 * d * d};
  };
  const Shape here = response_behind(xi - load), end = response_behind(1.0 - load);
  const auto form = rotated ? rotation(xi, 1.0, shear) : hermite(xi, 1.0, shear).value;
  return (rotated ? here.theta : here.value) - form[2] * end.value - form[3] * end.theta;
}

double fixed_end_by_force(double xi, double load, double h, double EI, double shear) {
  if (shear != 0.0) return h * h * h / EI * clamped_timoshenko_response(xi, load, shear, false, false);
  if (xi > load) return fixed_end_by_force(1.0 - xi, 1.0 - load, h, EI);
  const double b = 1.0 - load;
  return h * h * h / (6.0 * EI) * b * b * xi * xi * (3.0 * load - (1.0 + 2.0 * load) * xi);
}

double fixed_end_by_moment(double xi, double load, double h, double EI, double shear) {
  if (shear != 0.0) return h * h / EI * clamped_timoshenko_response(xi, load, shear, false, true);
  if (xi > load) return -fixed_end_by_moment(1.0 - xi, 1.0 - load, h, EI);
  return h * h / (2.0 * EI) * xi * xi * (1.0 - load) * (1.0 - 3.0 * load + 2.0 * load * xi);
}

}  // namespace traverse::beam
