// The running surface under a row of wheels, as part of the kernel (train_kernel.hpp).
#pragma once

#include "engine/train_vehicles.hpp"
#include "train/element_surface.hpp"

namespace traverse::engine {
namespace {

using train::Surface;
using Point = train::SurfacePoint<Row>;

/// The surface under a row of wheels, with stations s from `origin`: xi = xi_start + per_length s.
template <Surface kind>
struct SurfaceRows {
  train::ElementSurface<kind, Row> element;
  Row xi_start;
  Row h, h_x, h_xx;  // the profile about `origin`
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
  s.element.per_length = rows(p.per_length)[i];
  s.xi_start = (origin - rows(p.x)[i]) * s.element.per_length;
  const Row v0 = gather(task, slot, slot_order, o), v1 = gather(task, slot, slot_order, o + task.per_node);
  const Row left = length * gather(task, slot, slot_order, o + 1);
  const Row right = length * gather(task, slot, slot_order, o + 1 + task.per_node);
  s.element.set(kind == Surface::general ? rows(p.shear)[i] : Row{}, v0, left, v1, right);
  if constexpr (kind == Surface::general) {
    if (task.per_node == 3) {
      s.element.axial = gather(task, slot, slot_order, 0);
      s.element.axial_slope = gather(task, slot, slot_order, 3) - s.element.axial;
    }
    s.element.height = task.surface_height;
  }
  const Row moved = origin - rows(task.profile_station)[i], h_x = rows(task.h_x)[i], h_xx = rows(task.h_xx)[i];
  s.h = rows(task.h)[i] + moved * (h_x + 0.5 * moved * h_xx);
  s.h_x = h_x + moved * h_xx;
  s.h_xx = h_xx;
  return s;
}

/// The material point at `s` from the origin, its position relative to the origin.
template <Surface kind>
TRAVERSE_INLINE Point point_at(const SurfaceRows<kind>& f, Row s) {
  const Row level = f.h + s * (f.h_x + 0.5 * s * f.h_xx);
  Point p = {s, level, Rows::fill(1.0), f.h_x + s * f.h_xx, Row{}, f.h_xx};
  p.xi = f.xi_start + s * f.element.per_length;
  f.element.move(p);
  return p;
}

}  // namespace
}  // namespace traverse::engine
