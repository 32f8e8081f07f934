// Moment, shear and axial force at one section of an element as linear combinations of the element's nodal values, and
// the deflection inside an element that is clamped at both ends while a foundation acts on it: the response to loads
// inside the element that the cubic shape functions do not contain. With B the bending stiffness, k a bed and springs
// k_p,
//   B w'''' + k w + sum k_p w(s_p) delta(x - s_p) = load,   w = w' = 0 at both ends.
#pragma once

#include <vector>

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

/// A spring inside an element of length h, at xi: N/m, or N m/rad if it resists the rotation.
struct InnerSpring {
  double xi = 0.0;
  double k = 0.0;
  bool rotational = false;
};

/// The deflection at one station of a clamped element over the position of a unit load (an influence line).
class HeldElement {
 public:
  /// EI in N m2; bed in N/m2, 0 without a bed; shear: 12 EI/(GA h^2). For an element with shear the effect of a bed,
  /// about k h^4/(500 EI) of the deflection, is neglected.
  HeldElement(double xi, double h, double EI, double bed, const std::vector<InnerSpring>& springs, double shear = 0.0);

  /// m/N: under an upward unit force at `load`.
  double by_force(double load) const { return sum(load, false); }
  /// m/(N m): under a unit moment, counter-clockwise.
  double by_moment(double load) const { return sum(load, true); }
  /// Positions from 0 to 1, ascending, between which the lines are smooth enough for Gauss' rule.
  std::vector<double> ends() const;

 private:
  /// The influence line of the deflection, or of the rotation, at xi for the element on its bed without springs.
  struct Line {
    double xi = 0.0;
    bool rotation = false;
    double factor = 1.0;
    double ends[4] = {};  // amplitudes of the waves that decay from the left end and from the right end
  };
  Line line(double xi, bool rotation) const;
  /// The value of the line for the load at `load`, or its derivative there, divided by h^3/EI with xi as the length.
  double value(const Line& line, double load, bool slope) const;
  double sum(double load, bool moment) const;

  double h_, EI_, shear_;
  double lambda_;  // h (k/(4 EI))^(1/4); 0: the effect of the bed is negligible
  std::vector<Line> lines_;
};

}  // namespace traverse::beam
