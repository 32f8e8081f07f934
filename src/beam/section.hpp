// Moment, shear and axial force at one section of an element as linear combinations of the element's nodal values.
#pragma once

#include "beam/element.hpp"

namespace traverse::beam {

/// The coefficients of (v1, theta1, v2, theta2) and (u1, u2) in these forces, for one matrix of the element (K_e, C_e
/// or M_e).
///
/// The element's matrix determines the forces at its left end; the loads between the left end and the section at x are
/// added. With the end forces f = (K v)_1, m = (K v)_2, forces q and moments c at stations s:
///   shear(x) = f + sum q,   moment(x) = -m + f x + sum q (x - s) - sum c.
/// A load exactly at the section is left of it, except at the right end of the element.
class SectionForms {
 public:
  SectionForms(const Element& element, double xi) : element_(element), xi_(xi) {}

  /// Adds the forces at the left end, from a matrix of the element.
  void add_end_forces(const Transverse& matrix);
  void add_end_forces(const Axial& matrix);
  /// Adds inertia or a bed without end forces: the force on the beam is -density(x) psi v, or -density(x) phi u.
  void add_transverse_density(const Distribution& density);
  void add_axial_density(const Distribution& density);
  /// Adds rotary inertia or a rotational bed without end forces: the moment on the beam is -density(x) theta.
  void add_rotational_density(const Distribution& density);
  /// Adds a foundation in a direction, with its end forces. A bed acts with a force -density(x) psi v or -density(x)
  /// phi u, or with a moment -density(x) theta v, per length; a spring acts in the same way at xi, with c.
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

/// The largest distance between a load and a section at the same place, relative to the element's length. Rounding must
/// not determine on which side of a section a load is.
inline constexpr double section_tolerance = 1e-7;

/// Whether a load at xi is left of a section.
inline bool is_left(double xi, double section) {
  return xi < section - section_tolerance || (xi <= section + section_tolerance && section < 1.0 - section_tolerance);
}

/// Deflection at xi of an element clamped at both ends under a unit force at `load`, m/N. shear: 12 EI/(GA h^2).
double fixed_end_by_force(double xi, double load, double h, double EI, double shear = 0.0);
/// Deflection at xi of an element clamped at both ends under a unit counter-clockwise moment at `load`, m/(N m).
double fixed_end_by_moment(double xi, double load, double h, double EI, double shear = 0.0);
/// The deflection, or the rotation, at xi of a clamped Timoshenko element with h = 1 and EI = 1 under a unit force, or
/// a unit moment, at `load`.
double clamped_timoshenko_response(double xi, double load, double shear, bool rotated, bool moment);

}  // namespace traverse::beam
