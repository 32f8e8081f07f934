// The running surface on an element of the beam (wheel_on_track.hpp), for a number or a vector of numbers in SIMD
// lanes. It is compiled for several instruction sets (engine/train_kernel.hpp): all of it has internal linkage.
//
// A point at a height e above the neutral axis moves by (-e theta, -e theta^2/2), because plane sections rotate; theta
// = v' without shear. The second order term of y is necessary: the force is along the normal, which rotates with the
// section, and has no moment about the axis.
#pragma once

namespace traverse::train {
namespace {

/// The terms of the geometry. general: elements with unknowns along x, with shear, or a surface above the axis.
enum class Surface { flat, general };

/// A material point: its position, m, and the derivatives over its station; theta.
template <class Number>
struct SurfacePoint {
  Number x, y, x_x, y_x, x_xx, y_xx, xi{}, turn{};

  /// Half of the derivatives of the squared distance from a centre at (dx, dy) from the point: minus the first, second.
  [[gnu::always_inline]] Number approach(Number dx, Number dy) const { return dx * x_x + dy * y_x; }
  [[gnu::always_inline]] Number curvature(Number dx, Number dy) const {
    return x_x * x_x + y_x * y_x - dx * x_xx - dy * y_xx;
  }
};

/// The deflection of an element as a cubic of xi, and the terms of the general case.
template <Surface kind, class Number>
struct ElementSurface {
  Number per_length;                        // 1/m
  Number c[4];                              // coefficients of the deflection by powers of xi, m
  Number strain{}, axial{}, axial_slope{};  // v' - theta; displacement along x at xi = 0, and its increase to xi = 1
  double height = 0.0;                      // e, m

  /// From the deflections of both nodes and their rotations times the length.
  [[gnu::always_inline]] void set(Number shear, Number v0, Number left, Number v1, Number right) {
    const Number difference = v1 - v0;
    if constexpr (kind == Surface::general) {
      const Number sheared = shear / (1.0 + shear) * (difference - 0.5 * (left + right));
      strain = sheared * per_length;
      left += sheared;
      right += sheared;
    }
    c[0] = v0;
    c[1] = left;
    c[2] = 3.0 * difference - 2.0 * left - right;
    c[3] = left + right - 2.0 * difference;
  }
  /// Moves a point of the undeflected surface, at p.xi of the element.
  [[gnu::always_inline]] void move(SurfacePoint<Number>& p) const {
    const Number slope = (c[1] + p.xi * (2.0 * c[2] + p.xi * (3.0 * c[3]))) * per_length;
    const Number curvature = (2.0 * c[2] + p.xi * (6.0 * c[3])) * per_length * per_length;
    p.y = p.y + c[0] + p.xi * (c[1] + p.xi * (c[2] + p.xi * c[3]));
    p.y_x += slope;
    p.y_xx += curvature;
    p.turn = slope;
    if constexpr (kind == Surface::general) {
      const double e = height;
      const Number turn = slope - strain, third = 6.0 * c[3] * per_length * per_length * per_length;
      p.turn = turn;
      p.x += -e * turn + axial + p.xi * axial_slope;
      p.x_x += -e * curvature + axial_slope * per_length;
      p.x_xx -= e * third;
      p.y -= 0.5 * e * turn * turn;
      p.y_x -= e * turn * curvature;
      p.y_xx -= e * (curvature * curvature + turn * third);
    }
  }
};

/// The shapes of an element's unknowns (v, theta) of both nodes at xi: deflection, and rotation of the section.
template <class Number>
struct ElementShapes {
  Number value[4], turn[4];
};

template <Surface kind, class Number>
[[gnu::always_inline]] inline ElementShapes<Number> shapes_at(Number xi, Number length, Number shear) {
  const Number eta = 1.0 - xi, rise = xi * xi * (3.0 - 2.0 * xi);
  ElementShapes<Number> s;
  s.value[0] = 1.0 - rise;
  s.value[1] = length * xi * eta * eta;
  s.value[2] = rise;
  s.value[3] = -(length * xi * xi * eta);
  if constexpr (kind == Surface::general) {
    const Number share = shear / (1.0 + shear), odd = xi * eta * (eta - xi), odd_slope = 1.0 - 6.0 * xi * eta;
    const Number turned = (6.0 * xi * eta + share * (odd_slope - 1.0)) / length;
    s.turn[0] = -turned;
    s.turn[2] = turned;
    s.turn[1] = eta * (1.0 - 3.0 * xi) - 0.5 * share * (odd_slope - 1.0);
    s.turn[3] = xi * (3.0 * xi - 2.0) - 0.5 * share * (odd_slope - 1.0);
    s.value[0] -= share * odd;
    s.value[2] += share * odd;
    s.value[1] -= 0.5 * share * length * odd;
    s.value[3] -= 0.5 * share * length * odd;
  }
  return s;
}

/// The displacement of the surface in the direction (along, up) over each of the element's unknowns, per_node of them
/// at a node, where the section has turned by `turned`.
template <Surface kind, class Number>
[[gnu::always_inline]] inline void directions(const ElementShapes<Number>& s, int per_node, double height, Number xi,
                                              Number turned, Number up, Number along, Number* to) {
  const int o = per_node - 2;
  const int place[4] = {o, o + 1, per_node + o, per_node + o + 1};
  for (int k = 0; k < 4; ++k) {
    to[place[k]] = up * s.value[k];
    if constexpr (kind == Surface::general) {
      const Number aside = -height * s.turn[k];
      to[place[k]] += aside * (up * turned + along);
    }
  }
  if (kind == Surface::general && per_node == 3) {
    to[0] = along * (1.0 - xi);
    to[3] = along * xi;
  }
}

/// The compliance of an element clamped at its nodes for a force between them, m/N, and its derivative over x. With u =
/// xi (1 - xi), s = 12 EI/(GA h^2) and the flexibility h^3/(3 EI) it is h^3/(12 EI) ((4 u^3 + s u^2)/(1 + s) + s u).
template <class Number>
struct LocalCompliance {
  Number value, by_x;
};

template <Surface kind, class Number>
[[gnu::always_inline]] inline LocalCompliance<Number> local_compliance_at(Number xi, Number length, Number s,
                                                                          Number flexibility) {
  const Number u = xi * (1.0 - xi), by_x = (1.0 - 2.0 * xi) / length;
  const LocalCompliance<Number> stiff = {flexibility * u * u * u, flexibility * 3.0 * u * u * by_x};
  if constexpr (kind == Surface::flat) return stiff;
  const Number quarter = 0.25 * flexibility;
  const Number sheared = quarter * u * ((4.0 * u + s) * u / (1.0 + s) + s);
  const Number sheared_by_x = quarter * ((12.0 * u + 2.0 * s) * u / (1.0 + s) + s) * by_x;
  const auto is_stiff = s == 0.0;
  return {is_stiff ? stiff.value : sheared, is_stiff ? stiff.by_x : sheared_by_x};
}

/// The second derivative of that compliance over x, 1/(N m).
inline double local_compliance_by_xx(double xi, double length, double s, double flexibility) {
  const double u = xi * (1.0 - xi), by_x = (1.0 - 2.0 * xi) / length;
  const double slope = (12.0 * u + 2.0 * s) * u / (1.0 + s) + s, curvature = (24.0 * u + 2.0 * s) / (1.0 + s);
  return 0.25 * flexibility * (curvature * by_x * by_x - 2.0 * slope / (length * length));
}

}  // namespace
}  // namespace traverse::train
