// The vehicles' part of the kernel (train_kernel.hpp): their motion without contact forces, their compliance at the
// wheels, and the end of a step.
#pragma once

#include "engine/lane.hpp"
#include "engine/train_task.hpp"

namespace traverse::engine {
namespace {

using Rows = Lanes<Lanes<most_lanes>::in_a_row>;
inline constexpr int lanes = Lanes<most_lanes>::in_a_row;
using Row = Rows::Lane;
using RowMask = Rows::Mask;

inline const Row* rows(const double* numbers) { return Rows::lanes(numbers); }
inline Row* rows(double* numbers) { return Rows::lanes(numbers); }
inline const Row& row(const double* numbers) { return *rows(numbers); }
/// Entries of a matrix: numbers that all runs share, or rows with a number for each run.
template <class Entry>
const Entry* entries(const double* numbers) {
  return reinterpret_cast<const Entry*>(numbers);
}
inline Row spread(double entry) { return Rows::fill(entry); }
inline Row spread(Row entry) { return entry; }

/// The inverse of a matrix with positive definite symmetric part, in place, without pivoting.
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

/// y[row] += sign A[row, column] x[column]; the entries of a row are contiguous.
inline void add_product(const SparseRows& A, double sign, const Row* x, Row* y) {
  const Row* value = rows(A.value);
  for (int e = 0; e < A.count;) {
    const int i = A.row[e];
    Row sum{};
    for (; e < A.count && A.row[e] == i; ++e) sum += value[e] * x[A.column[e]];
    y[i] += sign * sum;
  }
}

/// n rows of the first matrix times x and of the second one times y: calls use(row, both products).
template <class Use>
void products(const PairedRows& A, int n, const Row* x, const Row* y, Use use) {
  const Row *first = rows(A.first), *second = rows(A.second);
  for (int i = 0, e = 0; i < n; ++i) {
    Row by_first{}, by_second{};
    for (int k = 0; k < A.width; ++k, ++e) {
      by_first += first[e] * x[A.column[e]];
      by_second += second[e] * y[A.column[e]];
    }
    use(i, by_first, by_second);
  }
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

/// Computes inverses and compliances for the common rate and displacement of the stages.
inline void set_step(const TrainTask& task) {
  const Row rate = row(task.stage[0].rate), displacement = row(task.stage[0].displacement);
  for (int k = 0; k < task.blocks; ++k) {
    const VehicleBlock& b = task.block[k];
    if (b.same_as >= 0) continue;
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

/// Positions and rates by a stage's rule, from n coordinates x, their rates w and `Known` accelerations.
template <int Known>
void combine(const StageRows& rule, int n, const Row* x, const Row* w, const Row* const* a, Row* position, Row* rate) {
  const Row w_in_v = row(rule.w_in_v);
  Row a_in_v[Known], a_in_w[Known];
  const Row* acceleration[Known];
  for (int j = 0; j < Known; ++j) {
    a_in_v[j] = row(rule.a_in_v[j]);
    a_in_w[j] = row(rule.a_in_w[j]);
    acceleration[j] = a[j];
  }
  for (int i = 0; i < n; ++i) {
    Row at = x[i] + w_in_v * w[i], moving = w[i];
    for (int j = 0; j < Known; ++j) {
      const Row own = acceleration[j][i];
      at += a_in_v[j] * own;
      moving += a_in_w[j] * own;
    }
    position[i] = at;
    rate[i] = moving;
  }
}
/// Like the function above, for the coordinates from `first` on.
inline void combine(int known, const StageRows& rule, int first, int n, const double* x, const double* w,
                    const double* const* accelerations, Row* position, Row* rate) {
  const Row* a[most_kept];
  for (int j = 0; j < known; ++j) a[j] = rows(accelerations[j]) + first;
  const Row *from = rows(x) + first, *rates = rows(w) + first;
  switch (known) {
    case 1:
      return combine<1>(rule, n, from, rates, a, position, rate);
    case 2:
      return combine<2>(rule, n, from, rates, a, position, rate);
    case 3:
      return combine<3>(rule, n, from, rates, a, position, rate);
    case 4:
      return combine<4>(rule, n, from, rates, a, position, rate);
    case 5:
      return combine<5>(rule, n, from, rates, a, position, rate);
    default:
      return combine<6>(rule, n, from, rates, a, position, rate);
  }
}

/// n coordinates, their rates and first accelerations at the end of a step.
inline void end_step(const TrainTask& task, int n, double* x, double* w, double* const* accelerations) {
  const Row w_in_v = row(task.end.w_in_v);
  Row *at = rows(x), *rate = rows(w), *a[most_kept], a_in_v[most_kept], a_in_w[most_kept];
  for (int j = 0; j < task.known; ++j) {
    a[j] = rows(accelerations[j]);
    a_in_v[j] = row(task.end.a_in_v[j]);
    a_in_w[j] = row(task.end.a_in_w[j]);
  }
  for (int i = 0; i < n; ++i) {
    Row next{}, position = at[i] + w_in_v * rate[i], moving = rate[i];
    for (int j = 0; j < task.known; ++j) {
      const Row own = a[j][i];
      position += a_in_v[j] * own;
      moving += a_in_w[j] * own;
      next += task.a_next[j] * own;
    }
    at[i] = position;
    rate[i] = moving;
    a[0][i] = next;
  }
}

/// y = A x for a square matrix by rows; four rows at a time use the processor better.
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

/// The initial guess of the contact forces and of the contact points.
inline void guess_forces(const TrainTask& task, const StageRows& rule, int stage, int first, int past) {
  for (int i = first; i < past; ++i) {
    Row guess{};
    for (int j = 0; j < stage; ++j) guess += row(rule.guess[j]) * rows(task.history[j])[i];
    for (int j = most_stages; j < most_stages + 2; ++j) guess += row(rule.guess[j]) * rows(task.history[j])[i];
    guess = guess > 0.0 ? guess : Row{};
    const Row before = rows(task.normal)[i], ratio = before > 0.0 ? guess / before : Row{};
    rows(task.root)[i] *= ratio > 0.5 ? (2.0 + ratio) * (1.0 / 3.0) : Rows::fill(1.0);  // approximates the cube root
    rows(task.force_along)[i] *= ratio;
    rows(task.force_up)[i] = before > 0.0 ? rows(task.force_up)[i] * ratio : guess;
    rows(task.normal)[i] = guess;
    const Row ahead = rows(task.ahead)[i], moving = ahead - rows(task.ahead_before)[i];
    rows(task.station)[i] = rows(task.along)[i] + ahead + task.extrapolation * moving;
    rows(task.ahead_before)[i] = ahead;
  }
}

/// The wheels' positions without contact forces, and the initial guess of these. `work`: three rows for each
/// coordinate.
inline void predict(const TrainTask& task, int stage, double* work) {
  const StageRows& rule = task.stage[stage];
  const Row displacement = row(rule.displacement);
  Row *at = rows(work), *force = at + task.coordinates;
  for (int k = 0; k < task.blocks; ++k) {
    const VehicleBlock& b = task.block[k];
    if (*b.active == 0) continue;
    const int first = b.first_coordinate, f = b.freedom;
    Row *rate = rows(task.w_predicted) + first, *free = rows(task.a_free) + first;
    combine(stage + 1, rule, first, f, task.x, task.w, task.a, at, rate);
    const Row acceleration = row(b.acceleration);
    products(b.K_and_C, f, at, rate,
             [&](int i, Row Kx, Row Cw) { force[i] = -(rows(b.r0)[i] + rows(b.driven)[i] * acceleration + Kx + Cw); });
    multiply(rows(b.inverse), f, force, free);
    for (int i = 0; i < f; ++i) at[i] += displacement * free[i];
    Row *up = rows(task.up) + b.first_wheel, *along = rows(task.along) + b.first_wheel;
    const Row *height = rows(task.height) + b.first_wheel, *place = rows(task.place) + b.first_wheel;
    products(b.both_G, b.wheels, at, at, [&](int j, Row lifted, Row moved) {
      up[j] = height[j] + lifted;
      along[j] = place[j] + row(b.distance) + moved;
    });
    guess_forces(task, rule, stage, b.first_wheel, b.first_wheel + b.wheels);
  }
}

/// Whether all wheels are between the stations where their patches are valid.
inline bool in_place(const TrainTask& task) {
  RowMask out{};
  for (int i = 0; i < task.wheels; ++i) {
    const Row x = rows(task.along)[i];
    out |= (x < rows(task.from)[i]) | (x > rows(task.to)[i]);
  }
  return !Rows::any(out);
}

/// The state at the end of the step.
inline void finish_step(const TrainTask& task) {
  end_step(task, task.coordinates, task.x, task.w, task.a);
  for (int i = 0; i < task.wheels; ++i) {
    rows(task.history[most_stages + 1])[i] = rows(task.history[most_stages])[i];
    rows(task.history[most_stages])[i] = rows(task.normal)[i];
  }
}
}  // namespace
}  // namespace traverse::engine
