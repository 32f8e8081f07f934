// The running surface under a row of wheels, as part of the kernel (train_kernel.hpp): the equations of
// wheel_on_track.hpp.
#pragma once

#include "engine/train_vehicles.hpp"

namespace traverse::engine {
namespace {

/// The terms of the contact geometry. general: elements with unknowns along x, with shear, or a surface above the axis.
enum class Surface { flat, general };

/// The surface under a row of wheels: the cubic of the deflection over xi, and the terms of the general case.
template <Surface kind>
struct SurfaceRows {
  Row xi_start, per_length;              // xi = (x - element's x)/length = xi_start + per_length s at s from `origin`
  Row c[4];                              // coefficients of the deflection by powers of xi, m
  Row strain{}, axial{}, axial_slope{};  // v' - theta; displacement along x at xi = 0, and its increase to xi = 1
  Row h, h_x, h_xx;                      // the profile about `origin`
  double height = 0.0;
};

/// Unknown k of the element in every lane, with these slots.
TRAVERSE_INLINE Row gather(const TrainTask& task, const int* slot, int slot_order, int k) {
  const double* nodal = task.nodal + task.offset[k];
  if (slot_order == contiguous) return *reinterpret_cast<const Rows::Unaligned*>(nodal + slot[0]);
  Row value{};
  if (slot_order == all_ground) return value;
  for (int l = 0; l < lanes; ++l) Rows::numbers(value)[l] = nodal[slot[l]];
  return value;
}

template <Surface kind>
TRAVERSE_INLINE SurfaceRows<kind> surface_under(const TrainTask& task, const SurfacePatch& p, int i, Row origin) {
  SurfaceRows<kind> s;
  const int *slot = p.slot + static_cast<long>(i) * lanes, o = task.per_node - 2, slot_order = p.slot_order[i];
  const Row length = rows(p.length)[i];
  s.per_length = rows(p.per_length)[i];
  s.xi_start = (origin - rows(p.x)[i]) * s.per_length;
  const Row v0 = gather(task, slot, slot_order, o), v1 = gather(task, slot, slot_order, o + task.per_node);
  Row left = length * gather(task, slot, slot_order, o + 1);
  Row right = length * gather(task, slot, slot_order, o + 1 + task.per_node);
  const Row difference = v1 - v0;
  if constexpr (kind == Surface::general) {
    const Row shear = rows(p.shear)[i], sheared = shear / (1.0 + shear) * (difference - 0.5 * (left + right));
    s.strain = sheared * s.per_length;
    left += sheared;
    right += sheared;
    if (task.per_node == 3) {
      s.axial = gather(task, slot, slot_order, 0);
      s.axial_slope = gather(task, slot, slot_order, 3) - s.axial;
    }
    s.height = task.surface_height;
  }
  s.c[0] = v0;
  s.c[1] = left;
  s.c[2] = 3.0 * difference - 2.0 * left - right;
  s.c[3] = left + right - 2.0 * difference;
  const Row moved = origin - rows(task.profile_station)[i], h_x = rows(task.h_x)[i], h_xx = rows(task.h_xx)[i];
  s.h = rows(task.h)[i] + moved * (h_x + 0.5 * moved * h_xx);
  s.h_x = h_x + moved * h_xx;
  s.h_xx = h_xx;
  return s;
}

/// A material point at `s` from the origin: its position relative to the origin, and the derivatives over s.
struct SurfacePoint {
  Row x, y, x_x, y_x, x_xx, y_xx, turn, xi;
};

template <Surface kind>
TRAVERSE_INLINE SurfacePoint point_at(const SurfaceRows<kind>& f, Row s) {
  SurfacePoint p;
  p.xi = f.xi_start + s * f.per_length;
  const Row slope = (f.c[1] + p.xi * (2.0 * f.c[2] + p.xi * (3.0 * f.c[3]))) * f.per_length;
  const Row curvature = (2.0 * f.c[2] + p.xi * (6.0 * f.c[3])) * f.per_length * f.per_length;
  const Row level = f.h + s * (f.h_x + 0.5 * s * f.h_xx);
  p.y = level + f.c[0] + p.xi * (f.c[1] + p.xi * (f.c[2] + p.xi * f.c[3]));
  p.y_x = f.h_x + s * f.h_xx + slope;
  p.y_xx = f.h_xx + curvature;
  p.x = s;
  p.x_x = Rows::fill(1.0);
  p.x_xx = Row{};
  p.turn = slope;
  if constexpr (kind == Surface::general) {
    const double e = f.height;
    const Row turn = slope - f.strain, third = 6.0 * f.c[3] * f.per_length * f.per_length * f.per_length;
    p.turn = turn;
    p.x += -e * turn + f.axial + p.xi * f.axial_slope;
    p.x_x += -e * curvature + f.axial_slope * f.per_length;
    p.x_xx = -e * third;
    p.y -= 0.5 * e * turn * turn;
    p.y_x -= e * turn * curvature;
    p.y_xx -= e * (curvature * curvature + turn * third);
  }
  return p;
}

/// The shapes of an element's unknowns (v, theta) of both nodes at xi: deflection, and rotation of the section.
struct Shapes {
  Row value[4], turn[4];
};

template <Surface kind>
TRAVERSE_INLINE Shapes shapes_at(Row xi, Row length, Row shear) {
  const Row eta = 1.0 - xi, rise = xi * xi * (3.0 - 2.0 * xi);
  Shapes s;
  s.value[0] = 1.0 - rise;
  s.value[1] = length * xi * eta * eta;
  s.value[2] = rise;
  s.value[3] = -(length * xi * xi * eta);
  if constexpr (kind == Surface::general) {
    const Row share = shear / (1.0 + shear), odd = xi * eta * (eta - xi), odd_slope = 1.0 - 6.0 * xi * eta;
    const Row turned = (6.0 * xi * eta + share * (odd_slope - 1.0)) / length;
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

/// The derivatives of the penetration by an element's unknowns, in their order (wheel_on_track.hpp: normal_on_beam),
/// from the components of the normal.
template <Surface kind>
TRAVERSE_INLINE void directions(const TrainTask& task, Row xi, Row length, Row shear, const double* turned, Row up,
                                Row along, Row* to) {
  const Shapes s = shapes_at<kind>(xi, length, shear);
  const int o = task.per_node - 2;
  const int place[4] = {o, o + 1, task.per_node + o, task.per_node + o + 1};
  for (int k = 0; k < 4; ++k) {
    to[place[k]] = up * s.value[k];
    if constexpr (kind == Surface::general) {
      const Row aside = -task.surface_height * s.turn[k];
      to[place[k]] += aside * (up * row(turned) + along);
    }
  }
  if (kind == Surface::general && task.per_node == 3) {
    to[0] = along * (1.0 - xi);
    to[3] = along * xi;
  }
}

/// The compliance of an element clamped at its nodes for a force between them, m/N, and its derivative over x
/// (wheel_on_track.cpp: local_compliance_of).
struct LocalCompliance {
  Row value, by_x;
};

template <Surface kind>
TRAVERSE_INLINE LocalCompliance local_compliance_at(Row xi, Row length, Row shear, Row flexibility) {
  const Row u = xi * (1.0 - xi), by_x = (1.0 - 2.0 * xi) / length;
  if constexpr (kind == Surface::flat) return {flexibility * u * u * u, flexibility * 3.0 * u * u * by_x};
  const Row quarter = 0.25 * flexibility, s = shear;
  const Row sheared = quarter * u * ((4.0 * u + s) * u / (1.0 + s) + s);
  const Row sheared_by_x = quarter * ((12.0 * u + 2.0 * s) * u / (1.0 + s) + s) * by_x;
  const RowMask stiff = s == 0.0;
  return {stiff ? flexibility * u * u * u : sheared, stiff ? flexibility * 3.0 * u * u * by_x : sheared_by_x};
}
}  // namespace
}  // namespace traverse::engine
