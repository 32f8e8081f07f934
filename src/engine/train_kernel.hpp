// Linear vehicles and their contacts with the structure in a stage of a one-step method (one_step_methods.hpp), with
// one vehicle in each SIMD lane.
//
//   vehicles   J a = G^T f - r0 - driven s'' - C w~ - K v~,   J = M + rate C + displacement K
//              The wheels move by H f, H = displacement G J^-1 G^T, from their positions without contact forces.
//   contacts   Newton's method determines each wheel's closest point on the surface; then its force N follows from
//
//                delta(N) + s N = radius - distance + q (N_before - N)
//
//              with all other forces unchanged. delta is the penetration of the contact law, s the local compliance of
//              the element (wheel_on_track.hpp), and q = H n n + compliance of the structure. A mask sets N = 0 for
//              open contacts.
//   structure  The caller computes its response to the new forces. This is repeated until no force changes.
//
// Not included: contact damping, friction, wheels out of round, several points of one wheel (linear_train.hpp:
// obstacle).
//
// Like all kernels this file is compiled once for each instruction set, and its functions must have internal linkage:
// it calls no library functions, and everything is in an unnamed namespace.
#pragma once

#include "engine/train_surface.hpp"

namespace traverse::engine {
namespace {

/// Whether the surface is at the axis of elements without shear and without axial unknowns.
inline bool is_flat(const TrainTask& task) { return task.per_node == 2 && task.surface_height == 0.0 && !task.shears; }

struct Touched {
  Row depth, up, along;   // m: the penetration; direction from the surface to the centre
  Row station, xi, turn;  // contact point: station in m, position in the element, rotation of the section
  RowMask below_surface;  // the centre is below the surface, and not beside its end
};

inline constexpr int closest_steps =
    1;  // iterations of Newton's method in a pass: the point moves little between passes

/// The point of the patch closest to the centre, which is at `along` and a radius above `up`. The penetration is
/// computed from e, the height of the centre above the surface minus the radius: e is small and keeps its digits.
template <Surface kind>
TRAVERSE_INLINE Touched closest(const TrainTask& task, const SurfacePatch& p, int i, Row along, Row up) {
  const Row origin = rows(task.station)[i];
  const SurfaceRows<kind> f = surface_under<kind>(task, p, i, origin);
  const Row low = rows(p.low)[i] - origin, high = rows(p.high)[i] - origin, across = along - origin;
  const auto within = [&](Row s) {
    s = s < low ? low : s;
    return s > high ? high : s;
  };
  const Row radius = rows(task.radius)[i];
  Row s = within(Row{});
  Point at = point_at(f, s);
  for (int step = 0; step < closest_steps; ++step) {
    const Row dx = across - at.x, dy = radius + (up - at.y);
    s = within(s + at.approach(dx, dy) / at.curvature(dx, dy));
    at = point_at(f, s);
  }
  const Row dx = across - at.x, e = up - at.y, dy = radius + e;
  const Row distance = Rows::root(dx * dx + dy * dy), inverse = 1.0 / distance;
  const Row depth = -(e * (radius + dy) + dx * dx) / (radius + distance);
  const RowMask beside = ((s == low) | (s == high)) & (depth < 0.0);
  const RowMask below_surface = ((dy <= 0.0) & ~beside) | (distance != distance);
  return {depth, dy * inverse, dx * inverse, origin + s, at.xi, at.turn, below_surface};
}

inline constexpr double least_root = 1e-6;  // m^0.5: initial guess for the next contact after a loss
inline constexpr int most_steps = 60;       // limit of a contact's own Newton iterations
inline constexpr double root_tolerance = 1e-14;

/// r with r^2 + relative_compliance r^3 = target > 0 of n wheels, from initial guesses, by Newton's method, which
/// passes the solution at most once. All wheels together, so that their divisions overlap; each stops when converged.
TRAVERSE_INLINE void hertz_roots(int n, const Row* relative_compliance, const Row* target, Row* r) {
  RowMask converged[most_wheels];
  for (int j = 0; j < n; ++j) converged[j] = RowMask{};
  for (int step = 0; step < most_steps; ++step) {
    RowMask all = ~RowMask{};
    for (int j = 0; j < n; ++j) {
      const Row x = r[j], excess = x * x * (1.0 + relative_compliance[j] * x) - target[j];
      Row next = x - excess / (x * (2.0 + 3.0 * relative_compliance[j] * x));
      next = next < 0.1 * x ? 0.1 * x : next;
      r[j] = converged[j] ? x : next;
      converged[j] |= ~(Rows::magnitude(next - x) > root_tolerance + 1e-6 * next);
      all &= converged[j];
    }
    if (!Rows::any(~all)) break;
  }
}

/// The touched patch and the contact point of one wheel in every lane.
struct ContactRow {
  Touched at;
  Row structure, local_compliance, local_compliance_by_x;
};

/// The contact with level rigid ground.
TRAVERSE_INLINE Touched on_ground(Row height, Row along, Row up) {
  return {height - up, Rows::fill(1.0), Row{}, along, Row{}, Row{}, up != up};
}

/// The compliances of the patch at the point.
template <Surface kind>
TRAVERSE_INLINE ContactRow on_patch(const SurfacePatch& p, int i, const Touched& at) {
  const Row length = rows(p.length)[i], shear = rows(p.shear)[i];
  const auto s = train::shapes_at<kind>(at.xi, length, shear);
  Row structure{};
  for (int a = 0, k = 0; a < 4; ++a) {
    Row sum{};
    for (int b = a; b < 4; ++b, ++k) sum += rows(p.compliance[k])[i] * s.value[b];
    structure += sum * s.value[a];
  }
  const auto local_compliance = train::local_compliance_at<kind>(at.xi, length, shear, rows(p.flexibility)[i]);
  return {at, structure, local_compliance.value, local_compliance.by_x};
}

/// a in the lanes of a mask, b in the others.
TRAVERSE_INLINE ContactRow select_rows(RowMask mask, const ContactRow& a, const ContactRow& b) {
  const auto of = [mask](Row x, Row y) { return mask ? x : y; };
  return {{of(a.at.depth, b.at.depth), of(a.at.up, b.at.up), of(a.at.along, b.at.along), of(a.at.station, b.at.station),
           of(a.at.xi, b.at.xi), of(a.at.turn, b.at.turn), mask ? a.at.below_surface : b.at.below_surface},
          of(a.structure, b.structure),
          of(a.local_compliance, b.local_compliance),
          of(a.local_compliance_by_x, b.local_compliance_by_x)};
}

/// The touched patch; if the wheel touches two patches, the patch with the larger penetration.
template <Surface kind>
ContactRow touched_patch(const TrainTask& task, int i, Row along, Row up) {
  const SurfacePatch &first = task.patch[0], &other = task.patch[1];
  int* active = task.active + static_cast<long>(i) * lanes;
  for (int l = 0; l < lanes; ++l) active[l] = 0;
  const ContactRow ground = {on_ground(rows(task.h)[i], along, up), Row{}, Row{}, Row{}};
  if (task.level[i] != 0 && task.touches_two_patches[i] == 0 && first.slot_order[i] == all_ground) return ground;
  ContactRow c = on_patch<kind>(first, i, closest<kind>(task, first, i, along, up));
  RowMask has_second{};
  if (task.touches_two_patches[i] != 0) {
    const ContactRow second = on_patch<kind>(other, i, closest<kind>(task, other, i, along, up));
    has_second = rows(other.high)[i] >= rows(other.low)[i];
    const RowMask second_touched = has_second & (second.at.depth > c.at.depth),
                  below_surface = c.at.below_surface | (has_second & second.at.below_surface);
    for (int l = 0; l < lanes; ++l) active[l] = Rows::is_set(second_touched, l) ? 1 : 0;
    c = select_rows(second_touched, second, c);
    c.at.below_surface = below_surface;
  }
  if (task.level[i] == 0 || first.slot_order[i] == contiguous) return c;
  // For level ground the result must not depend on the patches of other lanes.
  Row ground_lanes{};
  for (int l = 0; l < lanes; ++l) Rows::numbers(ground_lanes)[l] = first.slot[i * lanes + l] == task.ground ? 1.0 : 0.0;
  return select_rows((ground_lanes > 0.0) & ~has_second, ground, c);
}

/// The normal forces of n wheels, from wheel i on, each by the contact law with all other forces unchanged; `q`:
/// compliance of vehicle and structure.
TRAVERSE_INLINE void own_forces(const TrainTask& task, RowMask iterating, int i, int n, const Row* depth, const Row* q,
                                const Row* local_compliance, Row* force) {
  Row relative_compliance[most_wheels], target[most_wheels], root[most_wheels];
  for (int j = 0; j < n; ++j) {
    const Row all = (q[j] + local_compliance[j]) * rows(task.stiffness)[i + j],
              own = depth[j] + q[j] * rows(task.normal)[i + j];
    const RowMask touches = own > 0.0;
    relative_compliance[j] = touches ? all : Row{};
    target[j] = touches ? own : Row{};
    // Without contact the root is 1.
    root[j] = task.hertz[i + j] == 0 ? Rows::fill(1.0) : touches ? rows(task.root)[i + j] : Rows::fill(1.0);
    force[j] = touches ? own : Rows::fill(1.0);
  }
  hertz_roots(n, relative_compliance, force, root);
  for (int j = 0; j < n; ++j) {
    const RowMask touches = target[j] > 0.0;
    const Row stiffness = rows(task.stiffness)[i + j], r = root[j], least = Rows::fill(least_root);
    if (task.hertz[i + j] == 0) {
      force[j] = touches ? stiffness * target[j] / (1.0 + relative_compliance[j]) : Row{};
      continue;
    }
    Row& stored_root = rows(task.root)[i + j];
    stored_root = iterating & touches ? (r > least ? r : least) : stored_root;
    force[j] = touches ? stiffness * r * r * r : Row{};
  }
}

/// Whether another pass would change the forces of a vehicle on level rigid ground by no more than the tolerance,
/// estimated from the displacements of its wheels by the changes of the other wheels' forces.
inline RowMask would_converge(const TrainTask& task, const VehicleBlock& b, const Row* force) {
  const int m = b.wheels, first = b.first_wheel;
  RowMask converged = ~RowMask{};
  for (int j = 0; j < m; ++j) {
    const int i = first + j;
    if (task.level[i] == 0 || task.touches_two_patches[i] != 0 || task.patch[0].slot_order[i] != all_ground)
      return RowMask{};
    Row moved{};
    for (int l = 0; l < m; ++l)
      if (l != j) moved += Rows::magnitude(rows(b.H)[j * m + l] * (force[l] - rows(task.normal)[first + l]));
    const Row stiffness = rows(task.stiffness)[i],
              tangent = task.hertz[i] == 0 ? stiffness : 1.5 * stiffness * rows(task.root)[i];
    converged &= tangent * moved * rows(task.per_scale)[i] <= task.tolerance;
  }
  return converged;
}

/// The changes of a pass in each lane.
struct Changes {
  Row largest_change;     // largest change of a force over its scale
  RowMask below_surface;  // a wheel's centre is below the surface
};

/// Computes the forces of all contacts with the structure's motion in `nodal`, in the lanes that still iterate. The
/// others remain unchanged, so that no lane depends on its neighbours.
template <Surface kind>
Changes update_forces(const TrainTask& task, RowMask of_runs) {
  Row largest_change{};
  RowMask below_surface{};
  for (int k = 0; k < task.blocks; ++k) {
    const VehicleBlock& b = task.block[k];
    if (*b.active == 0) continue;
    const RowMask iterating = task.converged == nullptr ? of_runs : of_runs & (rows(task.converged)[k] == 0.0);
    if (!Rows::any(iterating)) continue;
    const int m = b.wheels, first = b.first_wheel;
    const Row* H = rows(b.H);
    const Row *up_forces = rows(task.force_up) + first, *along_forces = rows(task.force_along) + first;
    Row up[most_wheels], along[most_wheels];  // positions of all the block's wheels before the first force changes
    for (int j = 0; j < m; ++j) {
      Row y = rows(task.up)[first + j], x = rows(task.along)[first + j];
      for (int l = 0; l < m; ++l) {
        y += H[j * m + l] * up_forces[l] + H[(m + j) * m + l] * along_forces[l];
        x += H[(2 * m + j) * m + l] * up_forces[l] + H[(3 * m + j) * m + l] * along_forces[l];
      }
      up[j] = y;
      along[j] = x;
    }
    Row depth[most_wheels], q[most_wheels], local_compliance[most_wheels], local_compliance_by_x[most_wheels],
        force[most_wheels];
    for (int j = 0; j < m; ++j) {
      const int i = first + j;
      const ContactRow c = touched_patch<kind>(task, i, along[j], up[j]);
      below_surface |= c.at.below_surface;
      depth[j] = c.at.depth;
      q[j] = (H[j * m + j] + c.structure) * c.at.up * c.at.up;
      local_compliance[j] = c.local_compliance;
      local_compliance_by_x[j] = c.local_compliance_by_x;
      const auto store = [&](double* to, Row value) { rows(to)[i] = iterating ? value : rows(to)[i]; };
      store(task.normal_up, c.at.up);
      store(task.normal_along, c.at.along);
      store(task.turn, c.at.turn);
      store(task.ahead, c.at.station - along[j]);
      store(task.station, c.at.station);
    }
    own_forces(task, iterating, first, m, depth, q, local_compliance, force);
    RowMask converged{};
    if (task.converged != nullptr) {
      converged = would_converge(task, b, force);
      rows(task.converged)[k] = iterating & converged ? Rows::fill(1.0) : rows(task.converged)[k];
    }
    for (int j = 0; j < m; ++j) {
      const int i = first + j;
      const Row change = Rows::magnitude(force[j] - rows(task.normal)[i]) * rows(task.per_scale)[i];
      largest_change = (change <= largest_change) | converged ? largest_change : change;  // a NaN is kept
      const auto store = [&](double* to, Row value) { rows(to)[i] = iterating ? value : rows(to)[i]; };
      store(task.normal, force[j]);
      store(task.force_up, force[j] * rows(task.normal_up)[i]);
      // The work of the local compliance drives the wheel: f^2/2 ds/dx (wheel_on_track.hpp).
      store(task.force_along, force[j] * (rows(task.normal_along)[i] + 0.5 * local_compliance_by_x[j] * force[j]));
      store(task.penetration, depth[j]);
      store(task.local_compliance, local_compliance[j]);
    }
  }
  return {largest_change, below_surface};
}

/// Calls use(row of wheels, patch, directions) for all rows with wheels on elements.
template <Surface kind, class Use>
void for_wheels_on_elements(const TrainTask& task, Use use) {
  for (int i = 0; i < task.wheels; ++i)
    for (int patch = 0; patch < (task.touches_two_patches[i] != 0 ? 2 : 1); ++patch) {
      const SurfacePatch& p = task.patch[patch];
      if (p.slot_order[i] == all_ground) continue;
      const Row length = rows(p.length)[i], xi = (rows(task.station)[i] - rows(p.x)[i]) * rows(p.per_length)[i];
      Row direction[most_nodal];
      train::directions<kind>(train::shapes_at<kind>(xi, length, rows(p.shear)[i]), task.per_node, task.surface_height,
                              xi, rows(task.turn)[i], rows(task.normal_up)[i], rows(task.normal_along)[i], direction);
      use(i, patch, direction);
    }
}

/// Calls use(lane) for the lanes of a row whose wheels touch this patch of an element.
template <class Use>
void for_lanes_on(const TrainTask& task, int i, int patch, Use use) {
  const int* slot = task.patch[patch].slot + static_cast<long>(i) * lanes;
  const int* active = task.active + static_cast<long>(i) * lanes;
  for (int l = 0; l < lanes; ++l)
    if (active[l] == patch && slot[l] != task.ground) use(l);
}

/// Adds the contact forces to the loads on the elements.
template <Surface kind>
void add_loads(const TrainTask& task) {
  const int width = 2 * task.per_node;
  for_wheels_on_elements<kind>(task, [&](int i, int patch, const Row* direction) {
    const SurfacePatch& p = task.patch[patch];
    const int* slot = p.slot + static_cast<long>(i) * lanes;
    if (p.slot_order[i] == contiguous && task.touches_two_patches[i] == 0) {
      const Row force = rows(task.normal)[i];
      for (int k = 0; k < width; ++k)
        *reinterpret_cast<Rows::Unaligned*>(task.load + slot[0] + task.offset[k]) -= force * direction[k];
      return;
    }
    for_lanes_on(task, i, patch, [&](int l) {
      const double force = Rows::numbers(rows(task.normal)[i])[l];
      for (int k = 0; k < width; ++k) task.load[slot[l] + task.offset[k]] -= force * Rows::numbers(direction[k])[l];
    });
  });
}

/// The accelerations of a stage from its contact forces; with `kinematics` also the rates of wheels and contacts.
template <Surface kind>
void end_stage_of_train(const TrainTask& task, int stage, bool kinematics) {
  const Row rate = row(task.stage[stage].rate);
  Row dissipated{}, drive_power{};
  for (int k = 0; k < task.blocks; ++k) {
    const VehicleBlock& b = task.block[k];
    if (*b.active == 0) continue;
    const int f = b.freedom, m = b.wheels, first = b.first_coordinate;
    const Row *up = rows(task.force_up) + b.first_wheel, *along = rows(task.force_along) + b.first_wheel;
    Row *a = rows(task.a[stage + 1]) + first, *w = rows(task.w_predicted) + first;
    for (int i = 0; i < f; ++i) {
      Row sum = rows(task.a_free)[first + i];
      for (int j = 0; j < m; ++j) sum += rows(b.Y)[i * m + j] * up[j] + rows(b.Y_along)[i * m + j] * along[j];
      a[i] = sum;
    }
    if (task.dissipated == nullptr) continue;
    const Row travel_rate = row(b.rate);
    for (int i = 0; i < f; ++i) {
      w[i] += rate * a[i];
      drive_power += travel_rate * rows(b.driven)[i] * a[i];
    }
    drive_power += travel_rate * row(b.driven_mass) * row(b.acceleration);
    const Row* value = rows(b.C.value);
    for (int e = 0; e < b.C.count; ++e) dissipated += value[e] * w[b.C.row[e]] * w[b.C.column[e]];
    for (int j = 0; j < m; ++j) drive_power -= travel_rate * row(b.drive) * along[j];
    if (!kinematics) continue;
    Row *up_rate = rows(task.up_rate) + b.first_wheel, *along_rate = rows(task.along_rate) + b.first_wheel;
    for (int j = 0; j < m; ++j) {
      up_rate[j] = Row{};
      along_rate[j] = row(b.speed);
    }
    add_product(b.G, 1.0, w, up_rate);
    add_product(b.G_along, 1.0, w, along_rate);
  }
  if (task.dissipated != nullptr) {
    rows(task.dissipated)[stage + 1] = dissipated;
    rows(task.drive_power)[stage + 1] = drive_power;
  }
  for (int i = 0; i < task.wheels; ++i) {
    const Row force = rows(task.normal)[i], least = rows(task.least)[i], largest = rows(task.largest)[i];
    rows(task.history[stage])[i] = force;
    rows(task.least)[i] = force < least ? force : least;
    rows(task.largest)[i] = force > largest ? force : largest;
  }
  if (!kinematics) return;
  for (int i = 0; i < task.wheels; ++i)
    rows(task.penetration_rate)[i] =
        -rows(task.normal_up)[i] * rows(task.up_rate)[i] - rows(task.normal_along)[i] * rows(task.along_rate)[i];
  const int width = 2 * task.per_node;
  for_wheels_on_elements<kind>(task, [&](int i, int patch, const Row* direction) {
    const int* slot = task.patch[patch].slot + static_cast<long>(i) * lanes;
    for_lanes_on(task, i, patch, [&](int l) {
      double rising = 0.0;
      for (int k = 0; k < width; ++k)
        rising += Rows::numbers(direction[k])[l] * task.nodal_rate[slot[l] + task.offset[k]];
      Rows::numbers(rows(task.penetration_rate)[i])[l] += rising;
    });
  });
}
}  // namespace
}  // namespace traverse::engine
