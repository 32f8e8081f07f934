// Linear vehicles and their contacts with the structure in a stage of a one-step method (one_step_methods.hpp), eight
// vehicles at a time.
//
//   vehicles   J a = G^T f - r0 - C w~ - K v~,   J = M + rate C + displacement K
//              so that wheels move by H f, H = displacement G J^-1 G^T, from where they are without contact forces
//   contacts   each wheel's closest point on the surface by Newton's method; then its own force N from
//
//                delta(N) + seat N = radius - distance + q (N_before - N),   q = H n n + what the structure yields
//
//              with the contact law's penetration delta and the seat that the element itself makes
//              (wheel_on_track.hpp), all other forces held. Contacts that part have N = 0: a mask.
//   structure  moves under the new forces (the caller's affair), and so on until no force changes any more.
//
// Left out: contact damping, friction, wheels out of round, several points of one wheel (linear_train.hpp: obstacle).
//
// As all kernels it is compiled once for each kind of processor, and nothing in it may be seen by the linker: no
// functions of the library, everything in an unnamed namespace.
#pragma once

#include "engine/lane.hpp"
#include "engine/train_task.hpp"

namespace traverse::engine {
namespace {

using Rows = Lanes<block_lanes>;
using Row = Rows::Lane;
using RowMask = Rows::Mask;

inline const Row* rows(const double* numbers) { return Rows::lanes(numbers); }
inline Row* rows(double* numbers) { return Rows::lanes(numbers); }
inline const Row& row(const double* numbers) { return *rows(numbers); }

// --- vehicles --------------------------------------------------------------------------------------------------------

/// The inverse of a matrix whose symmetric part is positive, in place, without pivots.
inline void invert(Row* A, int n) {
  for (int k = 0; k < n; ++k) {
    const Row pivot = 1.0 / A[k * n + k];
    for (int j = 0; j < n; ++j) A[k * n + j] *= pivot;
    A[k * n + k] = pivot;
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const Row factor = A[i * n + k];
      A[i * n + k] = Row{};
      for (int j = 0; j < n; ++j) A[i * n + j] -= factor * A[k * n + j];
    }
  }
}

/// y[row] += scale A[row, column] x[column].
template <class Scale>
void add_product(const SparseRows& A, Scale scale, const Row* x, Row* y) {
  const Row* value = rows(A.value);
  for (int i = 0; i < A.count; ++i) y[A.row[i]] += scale * value[i] * x[A.column[i]];
}

/// to (freedom x wheels) = inverse G^T.
inline void respond(const VehicleBlock& b, const SparseRows& G, Row* to) {
  for (int i = 0; i < b.freedom * b.wheels; ++i) to[i] = Row{};
  const Row *inverse = rows(b.inverse), *value = rows(G.value);
  for (int e = 0; e < G.count; ++e)
    for (int i = 0; i < b.freedom; ++i) to[i * b.wheels + G.row[e]] += inverse[i * b.freedom + G.column[e]] * value[e];
}

/// to (wheels x wheels) = displacement G Y.
inline void compliance_of(const VehicleBlock& b, const SparseRows& G, const Row* Y, Row displacement, Row* to) {
  for (int i = 0; i < b.wheels * b.wheels; ++i) to[i] = Row{};
  const Row* value = rows(G.value);
  for (int e = 0; e < G.count; ++e)
    for (int j = 0; j < b.wheels; ++j)
      to[G.row[e] * b.wheels + j] += displacement * value[e] * Y[G.column[e] * b.wheels + j];
}

/// Of the stages' common rate and displacement.
inline void set_step(const TrainTask& task) {
  const Row rate = row(task.stage[0].rate), displacement = row(task.stage[0].displacement);
  for (int k = 0; k < task.blocks; ++k) {
    const VehicleBlock& b = task.block[k];
    const int f = b.freedom, m = b.wheels;
    Row* J = rows(b.inverse);
    for (int i = 0; i < f * f; ++i) J[i] = rows(b.M)[i];
    for (int e = 0; e < b.C.count; ++e) J[b.C.row[e] * f + b.C.column[e]] += rate * rows(b.C.value)[e];
    for (int e = 0; e < b.K.count; ++e) J[b.K.row[e] * f + b.K.column[e]] += displacement * rows(b.K.value)[e];
    invert(J, f);
    respond(b, b.G, rows(b.Y));
    respond(b, b.G_along, rows(b.Y_along));
    Row* H = rows(b.H);
    compliance_of(b, b.G, rows(b.Y), displacement, H);
    compliance_of(b, b.G, rows(b.Y_along), displacement, H + m * m);
    compliance_of(b, b.G_along, rows(b.Y), displacement, H + 2 * m * m);
    compliance_of(b, b.G_along, rows(b.Y_along), displacement, H + 3 * m * m);
  }
}

/// v~ and w~ of n coordinates from `Known` accelerations, from the first one on.
template <int Known>
void combine(const TrainTask& task, const StageRows& rule, int first, int n, Row* position, Row* rate) {
  const Row w_in_v = row(rule.w_in_v);
  Row a_in_v[Known], a_in_w[Known];
  for (int j = 0; j < Known; ++j) {
    a_in_v[j] = row(rule.a_in_v[j]);
    a_in_w[j] = row(rule.a_in_w[j]);
  }
  for (int i = 0; i < n; ++i) {
    const Row w = rows(task.w)[first + i];
    Row at = rows(task.x)[first + i] + w_in_v * w, moving = w;
    for (int j = 0; j < Known; ++j) {
      const Row a = rows(task.a[j])[first + i];
      at += a_in_v[j] * a;
      moving += a_in_w[j] * a;
    }
    position[i] = at;
    rate[i] = moving;
  }
}
inline void combine(int known, const TrainTask& task, const StageRows& rule, int first, int n, Row* position,
                    Row* rate) {
  switch (known) {
    case 1:
      return combine<1>(task, rule, first, n, position, rate);
    case 2:
      return combine<2>(task, rule, first, n, position, rate);
    case 3:
      return combine<3>(task, rule, first, n, position, rate);
    case 4:
      return combine<4>(task, rule, first, n, position, rate);
    case 5:
      return combine<5>(task, rule, first, n, position, rate);
    default:
      return combine<6>(task, rule, first, n, position, rate);
  }
}

/// y = A x for a square matrix by rows; four rows at a time keep the processor busy.
inline void multiply(const Row* A, int n, const Row* x, Row* y) {
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    const Row *A0 = A + i * n, *A1 = A0 + n, *A2 = A1 + n, *A3 = A2 + n;
    Row y0{}, y1{}, y2{}, y3{};
    for (int k = 0; k < n; ++k) {
      y0 += A0[k] * x[k];
      y1 += A1[k] * x[k];
      y2 += A2[k] * x[k];
      y3 += A3[k] * x[k];
    }
    y[i] = y0;
    y[i + 1] = y1;
    y[i + 2] = y2;
    y[i + 3] = y3;
  }
  for (; i < n; ++i) {
    Row sum{};
    for (int k = 0; k < n; ++k) sum += A[i * n + k] * x[k];
    y[i] = sum;
  }
}

/// Where wheels are without contact forces, and a first guess of these. `work`: three rows a coordinate.
inline void predict(const TrainTask& task, int stage, double* work) {
  const StageRows& rule = task.stage[stage];
  const Row displacement = row(rule.displacement);
  Row *at = rows(work), *force = at + task.coordinates;
  for (int k = 0; k < task.blocks; ++k) {
    const VehicleBlock& b = task.block[k];
    const int first = b.first_coordinate, f = b.freedom;
    Row *rate = rows(task.w_predicted) + first, *free = rows(task.a_free) + first;
    combine(stage + 1, task, rule, first, f, at, rate);
    for (int i = 0; i < f; ++i) force[i] = -rows(b.r0)[i];
    add_product(b.K, -1.0, at, force);
    add_product(b.C, -1.0, rate, force);
    multiply(rows(b.inverse), f, force, free);
    for (int i = 0; i < f; ++i) at[i] += displacement * free[i];
    Row *up = rows(task.up) + b.first_wheel, *along = rows(task.along) + b.first_wheel;
    for (int j = 0; j < b.wheels; ++j) {
      up[j] = rows(task.height)[b.first_wheel + j];
      along[j] = rows(task.place)[b.first_wheel + j] + row(b.distance);
    }
    add_product(b.G, 1.0, at, up);
    add_product(b.G_along, 1.0, at, along);
  }
  for (int i = 0; i < task.wheels; ++i) {
    Row guess{};
    for (int j = 0; j < stage; ++j) guess += row(rule.guess[j]) * rows(task.history[j])[i];
    for (int j = most_stages; j < most_stages + 2; ++j) guess += row(rule.guess[j]) * rows(task.history[j])[i];
    guess = guess > 0.0 ? guess : Row{};
    const Row before = rows(task.normal)[i], ratio = before > 0.0 ? guess / before : Row{};
    rows(task.force_along)[i] *= ratio;
    rows(task.force_up)[i] = before > 0.0 ? rows(task.force_up)[i] * ratio : guess;
    rows(task.normal)[i] = guess;
    const Row ahead = rows(task.ahead)[i], moving = ahead - rows(task.ahead_before)[i];
    rows(task.station)[i] = rows(task.along)[i] + ahead + task.onward * moving;
    rows(task.ahead_before)[i] = ahead;
  }
}

/// Whether all wheels are between the stations where their patches are known.
inline bool in_place(const TrainTask& task) {
  RowMask out{};
  for (int i = 0; i < task.wheels; ++i) {
    const Row x = rows(task.along)[i];
    out |= (x < rows(task.from)[i]) | (x > rows(task.to)[i]);
  }
  return !Rows::any(out);
}

// --- the surface -----------------------------------------------------------------------------------------------------

/// What the contact's geometry takes of an element: general: with unknowns along x, a surface above the axis, shear.
enum class Surface { flat, general };

/// The surface under eight wheels: the deflection's cubic over xi, with what makes it general.
template <Surface kind>
struct SurfaceRows {
  Row xi_start, per_length;              // xi = (x - element's x)/length = xi_start + per_length s at s from `origin`
  Row c[4];                              // of the deflection by powers of xi, m
  Row strain{}, axial{}, axial_slope{};  // v' - theta; displacement along x at xi = 0, and its rise to xi = 1
  Row h, h_x, h_xx;                      // the profile about `origin`
  double height = 0.0;
};

/// Eight nodal values, one a lane, `offset` behind the first of each slot.
inline Row gather(const double* nodal, const int* slot, int width, int offset) {
  Row value{};
  for (int l = 0; l < block_lanes; ++l) Rows::numbers(value)[l] = nodal[slot[l] * width + offset];
  return value;
}

template <Surface kind>
SurfaceRows<kind> surface_under(const TrainTask& task, const SurfacePatch& p, int i, Row origin) {
  SurfaceRows<kind> s;
  const int *slot = p.slot + static_cast<long>(i) * block_lanes, width = 2 * task.per_node, o = task.per_node - 2;
  const Row length = rows(p.length)[i];
  s.per_length = 1.0 / length;
  s.xi_start = (origin - rows(p.x)[i]) * s.per_length;
  const Row v0 = gather(task.nodal, slot, width, o), v1 = gather(task.nodal, slot, width, o + task.per_node);
  Row left = length * gather(task.nodal, slot, width, o + 1);
  Row right = length * gather(task.nodal, slot, width, o + 1 + task.per_node);
  const Row difference = v1 - v0;
  if constexpr (kind == Surface::general) {
    const Row shear = rows(p.shear)[i], sheared = shear / (1.0 + shear) * (difference - 0.5 * (left + right));
    s.strain = sheared * s.per_length;
    left += sheared;
    right += sheared;
    if (task.per_node == 3) {
      s.axial = gather(task.nodal, slot, width, 0);
      s.axial_slope = gather(task.nodal, slot, width, 3) - s.axial;
    }
    s.height = task.surface_height;
  }
  s.c[0] = v0;
  s.c[1] = left;
  s.c[2] = 3.0 * difference - 2.0 * left - right;
  s.c[3] = left + right - 2.0 * difference;
  const Row moved = origin - rows(task.looked_up)[i], h_x = rows(task.h_x)[i], h_xx = rows(task.h_xx)[i];
  s.h = rows(task.h)[i] + moved * (h_x + 0.5 * moved * h_xx);
  s.h_x = h_x + moved * h_xx;
  s.h_xx = h_xx;
  return s;
}

/// A material point `s` from the origin: where it is against the origin, and its derivatives over s.
struct SurfacePoint {
  Row x, y, x_x, y_x, x_xx, y_xx, turn, xi;
};

template <Surface kind>
SurfacePoint point_at(const SurfaceRows<kind>& f, Row s) {
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

// --- contacts --------------------------------------------------------------------------------------------------------

struct Touched {
  Row depth, up, along;   // m: the penetration; direction from the surface to the centre
  Row station, xi, turn;  // of the point: m, in the element, rotation of the section
  RowMask fallen;         // the centre is below the surface, and not beside its end
};

constexpr int closest_steps = 2;  // of Newton's method a pass: the point hardly moves from one pass to the next

/// The point of the patch that is closest to the centre, which is at `along` and a radius above `up`. With its height
/// e above the surface, less a radius, all that the penetration is computed from is small, so that it keeps its digits.
template <Surface kind>
Touched closest(const TrainTask& task, const SurfacePatch& p, int i, Row along, Row up) {
  const Row origin = rows(task.station)[i];
  const SurfaceRows<kind> f = surface_under<kind>(task, p, i, origin);
  const Row low = rows(p.low)[i] - origin, high = rows(p.high)[i] - origin, across = along - origin;
  const auto within = [&](Row s) {
    s = s < low ? low : s;
    return s > high ? high : s;
  };
  const Row radius = rows(task.radius)[i];
  Row s = within(Row{});
  SurfacePoint at = point_at(f, s);
  for (int step = 0; step < closest_steps; ++step) {
    const Row dx = across - at.x, dy = radius + (up - at.y);
    const Row slope = dx * at.x_x + dy * at.y_x;
    const Row bend = at.x_x * at.x_x + at.y_x * at.y_x - dx * at.x_xx - dy * at.y_xx;
    s = within(s + slope / bend);
    at = point_at(f, s);
  }
  const Row dx = across - at.x, e = up - at.y, dy = radius + e;
  const Row distance = Rows::root(dx * dx + dy * dy), inverse = 1.0 / distance;
  const Row depth = -(e * (radius + dy) + dx * dx) / (radius + distance);
  const RowMask beside = ((s == low) | (s == high)) & (depth < 0.0);
  const RowMask fallen = ((dy <= 0.0) & ~beside) | (distance != distance);
  return {depth, dy * inverse, dx * inverse, origin + s, at.xi, at.turn, fallen};
}

constexpr double least_root = 1e-6;  // m^0.5: from where the next contact is looked for after a loss
constexpr int most_steps = 60;       // of a contact's own Newton iteration
constexpr double root_tolerance = 1e-14;

/// r with r^2 + yielding r^3 = target > 0, from a guess, by Newton's method, which does not pass the solution twice.
inline Row hertz_root(Row guess, Row yielding, Row target) {
  Row r = guess;
  for (int step = 0; step < most_steps; ++step) {
    const Row excess = r * r * (1.0 + yielding * r) - target, slope = r * (2.0 + 3.0 * yielding * r);
    Row next = r - excess / slope;
    next = next < 0.1 * r ? 0.1 * r : next;
    const Row change = Rows::magnitude(next - r);
    r = next;
    if (!Rows::any(change > root_tolerance + 1e-7 * r)) break;
  }
  return r;
}

/// The shapes of an element's unknowns (v, theta) of both nodes at xi: deflection, and rotation of the section.
struct Shapes {
  Row value[4], turn[4];
};

template <Surface kind>
Shapes shapes_at(Row xi, Row length, Row shear) {
  const Row rest = 1.0 - xi, rise = xi * xi * (3.0 - 2.0 * xi);
  Shapes s;
  s.value[0] = 1.0 - rise;
  s.value[1] = length * xi * rest * rest;
  s.value[2] = rise;
  s.value[3] = -(length * xi * xi * rest);
  if constexpr (kind == Surface::general) {
    const Row share = shear / (1.0 + shear), odd = xi * rest * (rest - xi), odd_slope = 1.0 - 6.0 * xi * rest;
    const Row turned = (6.0 * xi * rest + share * (odd_slope - 1.0)) / length;
    s.turn[0] = -turned;
    s.turn[2] = turned;
    s.turn[1] = rest * (1.0 - 3.0 * xi) - 0.5 * share * (odd_slope - 1.0);
    s.turn[3] = xi * (3.0 * xi - 2.0) - 0.5 * share * (odd_slope - 1.0);
    s.value[0] -= share * odd;
    s.value[2] += share * odd;
    s.value[1] -= 0.5 * share * length * odd;
    s.value[3] -= 0.5 * share * length * odd;
  }
  return s;
}

/// How the penetration grows with an element's unknowns, in their order (wheel_on_track.hpp: normal_on_beam), from the
/// normal's parts.
template <Surface kind>
void directions(const TrainTask& task, Row xi, Row length, Row shear, const double* turned, Row up, Row along,
                Row* to) {
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

/// What an element clamped at its nodes yields to a force in it, m/N, and its rise over x (wheel_on_track.cpp:
/// seat_of).
struct Seat {
  Row value, by_x;
};

template <Surface kind>
Seat seat_at(Row xi, Row length, Row shear, Row yield) {
  const Row hump = xi * (1.0 - xi), by_x = (1.0 - 2.0 * xi) / length;
  if constexpr (kind == Surface::flat) return {yield * hump * hump * hump, yield * 3.0 * hump * hump * by_x};
  const Row quarter = 0.25 * yield, s = shear;
  const Row sheared = quarter * hump * ((4.0 * hump + s) * hump / (1.0 + s) + s);
  const Row sheared_by_x = quarter * ((12.0 * hump + 2.0 * s) * hump / (1.0 + s) + s) * by_x;
  const RowMask stiff = s == 0.0;
  return {stiff ? yield * hump * hump * hump : sheared, stiff ? yield * 3.0 * hump * hump * by_x : sheared_by_x};
}

/// One wheel of eight vehicles: the patch that it touches, and the point.
struct Contact8 {
  Touched at;
  Row length, shear, structure, seat, seat_by_x;
};

/// What the patch makes of a force at the point.
template <Surface kind>
Contact8 on_patch(const SurfacePatch& p, int i, const Touched& at) {
  const Row length = rows(p.length)[i], shear = rows(p.shear)[i];
  const Shapes s = shapes_at<kind>(at.xi, length, shear);
  Row structure{};
  for (int a = 0, k = 0; a < 4; ++a) {
    Row sum{};
    for (int b = a; b < 4; ++b, ++k) sum += rows(p.compliance[k])[i] * s.value[b];
    structure += sum * s.value[a];
  }
  const Seat seat = seat_at<kind>(at.xi, length, shear, rows(p.yield)[i]);
  return {at, length, shear, structure, seat.value, seat.by_x};
}

/// The patch that is touched: of two the one where the wheel is deeper.
template <Surface kind>
Contact8 touched_patch(const TrainTask& task, int i, Row along, Row up) {
  Contact8 c = on_patch<kind>(task.patch[0], i, closest<kind>(task, task.patch[0], i, along, up));
  int* active = task.active + static_cast<long>(i) * block_lanes;
  for (int l = 0; l < block_lanes; ++l) active[l] = 0;
  if (task.second[i] == 0) return c;
  const SurfacePatch& p = task.patch[1];
  const Contact8 other = on_patch<kind>(p, i, closest<kind>(task, p, i, along, up));
  const RowMask two = rows(p.high)[i] >= rows(p.low)[i], there = two & (other.at.depth > c.at.depth);
  const auto choose = [there](Row a, Row b) { return there ? a : b; };
  for (int l = 0; l < block_lanes; ++l) active[l] = Rows::holds(there, l) ? 1 : 0;
  return {{choose(other.at.depth, c.at.depth), choose(other.at.up, c.at.up), choose(other.at.along, c.at.along),
           choose(other.at.station, c.at.station), choose(other.at.xi, c.at.xi), choose(other.at.turn, c.at.turn),
           c.at.fallen | (two & other.at.fallen)},
          choose(other.length, c.length),
          choose(other.shear, c.shear),
          choose(other.structure, c.structure),
          choose(other.seat, c.seat),
          choose(other.seat_by_x, c.seat_by_x)};
}

/// The normal force with all others held, by the law; `q`: what vehicle and structure yield to it.
inline Row own_force(const TrainTask& task, int i, Row depth, Row q, Row seat) {
  const Row stiffness = rows(task.stiffness)[i], yielding = (q + seat) * stiffness;
  const Row target = depth + q * rows(task.normal)[i];
  const RowMask touches = target > 0.0;
  const Row one = Rows::fill(1.0), safe = touches ? target : one;
  if (task.hertz[i] == 0) return touches ? stiffness * safe / (1.0 + yielding) : Row{};
  Row& root = rows(task.root)[i];
  const Row r = hertz_root(touches ? root : one, touches ? yielding : Row{}, safe), least = Rows::fill(least_root);
  root = touches ? (r > least ? r : least) : root;
  return touches ? stiffness * r * r * r : Row{};
}

/// The forces of all contacts with the structure as `nodal` has it. Returns the largest change of a force over its
/// scale, or a number below 0 where a wheel has fallen below the surface.
template <Surface kind>
double renew_contacts(const TrainTask& task) {
  Row most{};
  RowMask fallen{};
  for (int k = 0; k < task.blocks; ++k) {
    const VehicleBlock& b = task.block[k];
    const int m = b.wheels, first = b.first_wheel;
    const Row* H = rows(b.H);
    const Row *up_forces = rows(task.force_up) + first, *along_forces = rows(task.force_along) + first;
    Row up[most_wheels], along[most_wheels];  // of all the block's wheels before the first force changes
    for (int j = 0; j < m; ++j) {
      Row y = rows(task.up)[first + j], x = rows(task.along)[first + j];
      for (int l = 0; l < m; ++l) {
        y += H[j * m + l] * up_forces[l] + H[(m + j) * m + l] * along_forces[l];
        x += H[(2 * m + j) * m + l] * up_forces[l] + H[(3 * m + j) * m + l] * along_forces[l];
      }
      up[j] = y;
      along[j] = x;
    }
    for (int j = 0; j < m; ++j) {
      const int i = first + j;
      const Contact8 c = touched_patch<kind>(task, i, along[j], up[j]);
      const Row depth = c.at.depth, before = rows(task.normal)[i];
      fallen |= c.at.fallen;
      const Row force = own_force(task, i, depth, (H[j * m + j] + c.structure) * c.at.up * c.at.up, c.seat);
      const Row change = Rows::magnitude(force - before) / rows(task.scale)[i];
      most = change > most ? change : most;
      rows(task.normal)[i] = force;
      rows(task.normal_up)[i] = c.at.up;
      rows(task.normal_along)[i] = c.at.along;
      rows(task.force_up)[i] = force * c.at.up;
      // The element's inner shape drives the wheel on: f^2/2 ds/dx (wheel_on_track.hpp).
      rows(task.force_along)[i] = force * (c.at.along + 0.5 * c.seat_by_x * force);
      rows(task.penetration)[i] = depth;
      rows(task.turn)[i] = c.at.turn;
      rows(task.seat)[i] = c.seat;
      rows(task.ahead)[i] = c.at.station - along[j];
      rows(task.station)[i] = c.at.station;
    }
  }
  if (Rows::any(fallen)) return -1.0;
  double largest = 0.0;
  for (int l = 0; l < block_lanes; ++l)
    if (!(Rows::numbers(most)[l] <= largest)) largest = Rows::numbers(most)[l];
  return largest;
}

/// use(row of wheels, lane, slot, directions): of all wheels on elements.
template <Surface kind, class Use>
void for_wheels_on_elements(const TrainTask& task, Use use) {
  for (int i = 0; i < task.wheels; ++i)
    for (int patch = 0; patch < (task.second[i] != 0 ? 2 : 1); ++patch) {
      const SurfacePatch& p = task.patch[patch];
      const Row length = rows(p.length)[i], xi = (rows(task.station)[i] - rows(p.x)[i]) / length;
      Row direction[most_nodal];
      directions<kind>(task, xi, length, rows(p.shear)[i], task.turn + static_cast<long>(i) * block_lanes,
                       rows(task.normal_up)[i], rows(task.normal_along)[i], direction);
      const int *slot = p.slot + static_cast<long>(i) * block_lanes,
                *active = task.active + static_cast<long>(i) * block_lanes;
      for (int l = 0; l < block_lanes; ++l)
        if (active[l] == patch && slot[l] != task.slots - 1) use(i, l, slot[l], direction);
    }
}

/// The contacts' forces as loads on the elements, into `load`.
template <Surface kind>
void load_structure(const TrainTask& task) {
  const int width = 2 * task.per_node;
  for (int i = 0; i < task.slots * width; ++i) task.load[i] = 0.0;
  for_wheels_on_elements<kind>(task, [&](int i, int l, int slot, const Row* direction) {
    const double force = Rows::numbers(rows(task.normal)[i])[l];
    for (int k = 0; k < width; ++k) task.load[slot * width + k] -= force * Rows::numbers(direction[k])[l];
  });
}

/// The accelerations of a stage from its contact forces; with `kinematics` the rates of wheels and contacts too.
template <Surface kind>
void take_forces(const TrainTask& task, int stage, bool kinematics) {
  const Row rate = row(task.stage[stage].rate);
  Row lost{}, given{};
  for (int k = 0; k < task.blocks; ++k) {
    const VehicleBlock& b = task.block[k];
    const int f = b.freedom, m = b.wheels, first = b.first_coordinate;
    const Row *up = rows(task.force_up) + b.first_wheel, *along = rows(task.force_along) + b.first_wheel;
    Row *a = rows(task.a[stage + 1]) + first, *w = rows(task.w_predicted) + first;
    for (int i = 0; i < f; ++i) {
      Row sum = rows(task.a_free)[first + i];
      for (int j = 0; j < m; ++j) sum += rows(b.Y)[i * m + j] * up[j] + rows(b.Y_along)[i * m + j] * along[j];
      a[i] = sum;
      w[i] += rate * sum;
      given += rows(b.driven)[i] * sum;
    }
    const Row* value = rows(b.C.value);
    for (int e = 0; e < b.C.count; ++e) lost += value[e] * w[b.C.row[e]] * w[b.C.column[e]];
    for (int j = 0; j < m; ++j) given -= row(b.drive) * along[j];
    if (!kinematics) continue;
    Row *up_rate = rows(task.up_rate) + b.first_wheel, *along_rate = rows(task.along_rate) + b.first_wheel;
    for (int j = 0; j < m; ++j) {
      up_rate[j] = Row{};
      along_rate[j] = row(b.speed);
    }
    add_product(b.G, 1.0, w, up_rate);
    add_product(b.G_along, 1.0, w, along_rate);
  }
  rows(task.lost)[stage + 1] = lost;
  rows(task.given)[stage + 1] = given;
  for (int i = 0; i < task.wheels; ++i) {
    const Row force = rows(task.normal)[i], largest = rows(task.largest)[i];
    rows(task.history[stage])[i] = force;
    rows(task.largest)[i] = force > largest ? force : largest;
  }
  if (!kinematics) return;
  for (int i = 0; i < task.wheels; ++i)
    rows(task.penetration_rate)[i] =
        -rows(task.normal_up)[i] * rows(task.up_rate)[i] - rows(task.normal_along)[i] * rows(task.along_rate)[i];
  const int width = 2 * task.per_node;
  for_wheels_on_elements<kind>(task, [&](int i, int l, int slot, const Row* direction) {
    double rising = 0.0;
    for (int k = 0; k < width; ++k) rising += Rows::numbers(direction[k])[l] * task.nodal_rate[slot * width + k];
    Rows::numbers(rows(task.penetration_rate)[i])[l] += rising;
  });
}

/// The state at the end of the step.
inline void finish_step(const TrainTask& task) {
  const StageRows& rule = task.end;
  const Row w_in_v = row(rule.w_in_v);
  for (int i = 0; i < task.coordinates; ++i) {
    Row &x = rows(task.x)[i], &w = rows(task.w)[i], next{};
    Row at = x + w_in_v * w, rate = w;
    for (int j = 0; j < task.known; ++j) {
      const Row a = rows(task.a[j])[i];
      at += row(rule.a_in_v[j]) * a;
      rate += row(rule.a_in_w[j]) * a;
      next += task.a_next[j] * a;
    }
    x = at;
    w = rate;
    rows(task.a[0])[i] = next;
  }
  for (int i = 0; i < task.wheels; ++i) {
    rows(task.history[most_stages + 1])[i] = rows(task.history[most_stages])[i];
    rows(task.history[most_stages])[i] = rows(task.normal)[i];
  }
}

}  // namespace
}  // namespace traverse::engine
