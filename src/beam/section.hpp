// Moment, shear and axial force at one section of an element as linear forms of the element's nodal values.
#pragma once

#include "beam/element.hpp"

namespace traverse::beam {

/// Forms for one matrix of the element (K_e, C_e or M_e): coefficients of (v1, theta1, v2, theta2) and (u1, u2).
///
/// The element's matrix gives the forces at its left end; what acts on the beam between there and the section, x from
/// the left end, is added. With the end forces f = (K v)_1, m = (K v)_2, forces q and moments c at stations s:
///   shear(x) = f + sum q,   moment(x) = -m + f x + sum q (x - s) - sum c.
/// What stands exactly on the section is left of it, except at the right end of the element.
class SectionForms {
 public:
  SectionForms(const Element& element, double xi) : element_(element), xi_(xi) {}

  /// The forces at the left end, by a matrix of the element.
  void add_end_forces(const Transverse& matrix);
  void add_end_forces(const Axial& matrix);
  /// Inertia or a bed: the force on the beam is -density(x) psi v, or -density(x) phi u; without end forces.
  void add_transverse_density(const Distribution& density);
  void add_axial_density(const Distribution& density);
  /// Rotary inertia or a bed that holds the rotation: the moment on the beam is -density(x) theta.
  void add_rotational_density(const Distribution& density);
  /// A foundation in a direction, with its end forces. A bed: a force -density(x) psi v per length, a moment
  /// -density(x) theta v, or a force -density(x) phi u; a spring at xi: the same concentrated, with c.
  void add_bed(Direction direction, const Distribution& density);
  void add_spring(Direction direction, double c, double xi);

  const std::array<double, 4>& moment() const { return moment_; }
  const std::array<double, 4>& shear() const { return shear_; }
  const std::array<double, 2>& axial_force() const { return axial_force_; }

 private:
  void add_vertical_spring(double c, double xi);
  void add_rotational_spring(double c, double xi);
  void add_longitudinal_spring(double c, double xi);

  Element element_;
  double xi_ = 0.0;
  std::array<double, 4> moment_{}, shear_{};
  std::array<double, 2> axial_force_{};
};

/// Whether what stands at xi is left of a section.
inline bool is_left(double xi, double section) { return xi < section || (xi == section && section < 1.0); }

/// Deflection at xi of an element clamped at both ends under a unit force at `load`, m/N. shear: 12 EI/(GA h^2).
double fixed_end_by_force(double xi, double load, double h, double EI, double shear = 0.0);
/// The same under a unit moment, counter-clockwise, m/(N m).
double fixed_end_by_moment(double xi, double load, double h, double EI, double shear = 0.0);
/// Of a clamped element with h = 1 and EI = 1 that shears: the deflection at xi, or the rotation (`turn`), under a unit
/// force at `load`, or a unit moment.
double sheared_between_held_ends(double xi, double load, double shear, bool turn, bool moment);

}  // namespace traverse::beam
