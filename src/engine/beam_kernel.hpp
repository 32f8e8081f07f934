// The structure's side of a stage (beam_task.hpp): J a = P + forces - C w~ - K v~ with J = M + rate C + displacement K,
// from w = w~ + rate a and v = v~ + displacement a.
//
// Columns are eliminated from both ends to the middle column. The contact forces change from pass to pass. In each pass
// only the window of columns under the wheels is solved; the columns outside it are eliminated once before the passes
// of a stage, and solved after them. If the window has left the middle, the middle is moved to it. All functions
// of the kernels must have internal linkage (train_kernel.hpp).
#pragma once

#include "engine/beam_task.hpp"
#include "engine/train_vehicles.hpp"

namespace traverse::engine {
namespace {

/// The structure with blocks of `Size` unknowns; 0: any size.
template <int Size>
struct BeamRows {
  BeamTask& t;
  const int b = Size > 0 ? Size : t.block, bb = b * b;

  Row* pivot(int column) const { return rows(t.pivot) + static_cast<long>(column) * bb; }
  /// The factor of columns `pair` and pair + 1: rows of the column nearer to the middle.
  Row* factor(int pair) const { return rows(t.factor) + static_cast<long>(pair) * bb; }
  /// Calls use(pair, further, nearer) for the pairs from column `left` on to `to_left`, and from `right` back to
  /// `to_right`, alternately: two independent chains of products use the processor better.
  template <class Use>
  void inwards(int left, int right, int to_left, int to_right, Use use) const {
    const int before = to_left - left, behind = right - to_right;
    for (int k = 0; k < (before > behind ? before : behind); ++k) {
      if (k < before) use(left + k, left + k, left + k + 1);
      if (k < behind) use(right - k - 1, right - k, right - k - 1);
    }
  }
  /// The same pairs as inwards(), in the opposite order.
  template <class Use>
  void outwards(int left, int right, int to_left, int to_right, Use use) const {
    const int before = to_left - left, behind = right - to_right;
    for (int k = (before > behind ? before : behind) - 1; k >= 0; --k) {
      if (k < before) use(left + k, left + k, left + k + 1);
      if (k < behind) use(right - k - 1, right - k, right - k - 1);
    }
  }

  void factorise(Row rate, Row displacement) const {
    const int end = t.columns - 1;
    inwards(0, end, t.middle, t.middle,
            [&](int pair, int further, int nearer) { eliminate(pair, further, nearer, rate, displacement); });
    invert_middle(rate, displacement);
    find_compliance(displacement);
  }

  /// Sets the window to the columns under wheels.
  void set_window(const TrainTask& train, Row rate, Row displacement) const {
    constexpr int worth_moving = 32;
    int first = t.columns, last = -1;
    for (const SurfacePatch& p : train.patch)
      for (int at = 0; at < train.wheels * lanes; ++at) {
        if (p.slot[at] == train.ground) continue;
        const int column = p.slot[at] / lanes / b;
        first = column < first ? column : first;
        last = column + 1 > last ? column + 1 : last;
      }
    if (last < 0) first = last = t.middle;
    t.first = first < t.middle ? first : t.middle;
    t.last = last > t.middle ? last : t.middle;
    if (t.last - t.first <= 2 * (last - first) + worth_moving) return;
    t.first = first;
    t.last = last;
    move_middle((first + last) / 2, rate, displacement);
  }

  /// Eliminates the columns outside the window.
  void begin_passes() const {
    inwards(0, t.columns - 1, t.first, t.last, [&](int pair, int further, int nearer) {
      subtract(factor(pair), rows(t.residual) + further * b, rows(t.residual) + nearer * b);
    });
  }
  void clear_loads() const {
    for (int i = t.first * b; i < (t.last + 1) * b; ++i) rows(t.work)[i] = rows(t.residual)[i];
  }
  /// Solves the window under the present forces, in open lanes.
  void solve(Row displacement, RowMask open) const {
    Row *x = rows(t.work), *solution = rows(t.solution), *v = rows(t.v_stage);
    inwards(t.first, t.last, t.middle, t.middle,
            [&](int pair, int further, int nearer) { subtract(factor(pair), x + further * b, x + nearer * b); });
    for (int c = t.first; c <= t.last; ++c) multiply(pivot(c), x + c * b, x + c * b);
    outwards(t.first, t.last, t.middle, t.middle,
             [&](int pair, int further, int nearer) { subtract<true>(factor(pair), x + nearer * b, x + further * b); });
    for (int i = t.first * b; i < (t.last + 1) * b; ++i) {
      solution[i] = open ? x[i] : solution[i];
      v[i] = rows(t.v_predicted)[i] + displacement * solution[i];
    }
  }
  /// Solves the columns outside the window.
  void end_passes() const {
    Row* x = rows(t.solution);
    outwards(0, t.columns - 1, t.first, t.last, [&](int pair, int further, int nearer) {
      multiply(pivot(further), rows(t.residual) + further * b, x + further * b);
      subtract<true>(factor(pair), x + nearer * b, x + further * b);
    });
  }

  /// r with J x = r + forces. With damping C = a M + b K no product with C is needed: with alpha = a/(1 + rate a)
  ///
  ///   J (acceleration + alpha w~) = P + forces - K (v~ + (b - alpha (displacement + rate b)) w~)
  ///
  /// Then x is the acceleration plus alpha w~, and v~ is reduced accordingly. Otherwise x is the acceleration.
  void find_residual(Row rate, Row displacement) const {
    Row *v = rows(t.v_predicted), *w = rows(t.w_predicted), *r = rows(t.residual), *u = rows(t.work);
    const int n = t.unknowns;
    for (int i = 0; i < n; ++i) r[i] = t.shared ? Rows::fill(t.dead[i]) : rows(t.dead)[i];
    if (!t.proportional) {
      subtract_product(&ColumnMatrices::stiffness, v, r);
      subtract_product(&ColumnMatrices::damping, w, r);
      return;
    }
    const Row by_stiffness = row(t.by_stiffness), alpha = shift(rate);
    const Row of_w = by_stiffness - alpha * (displacement + rate * by_stiffness);
    for (int i = 0; i < n; ++i) {
      u[i] = v[i] + of_w * w[i];
      v[i] -= displacement * alpha * w[i];
    }
    subtract_product(&ColumnMatrices::stiffness, u, r);
  }
  /// The accelerations from x.
  void accelerations(Row rate, Row* a) const {
    const Row *w = rows(t.w_predicted), *x = rows(t.solution), alpha = t.proportional ? shift(rate) : Row{};
    for (int i = 0; i < t.unknowns; ++i) a[i] = x[i] - alpha * w[i];
  }

  static constexpr int most_block = Size > 0 ? Size : most_unknowns_of_a_column;

 private:
  Row shift(Row rate) const { return row(t.by_mass) / (1.0 + rate * row(t.by_mass)); }

  /// y -= A x, or A^T x, for one block by rows.
  template <bool transposed = false>
  void subtract(const Row* A, const Row* x, Row* y) const {
    Row sum[most_block];
    for (int i = 0; i < b; ++i) {
      sum[i] = y[i];
      for (int k = 0; k < b; ++k) sum[i] -= A[transposed ? k * b + i : i * b + k] * x[k];
    }
    for (int i = 0; i < b; ++i) y[i] = sum[i];
  }
  /// y = A x.
  void multiply(const Row* A, const Row* x, Row* y) const {
    Row of[most_block];
    for (int i = 0; i < b; ++i) of[i] = x[i];
    for (int i = 0; i < b; ++i) {
      Row sum = A[i * b] * of[0];
      for (int k = 1; k < b; ++k) sum += A[i * b + k] * of[k];
      y[i] = sum;
    }
  }

  /// Stores the diagonal block of J, by rows.
  void set_diagonal(int column, Row rate, Row displacement) const {
    const char* held = t.held + static_cast<long>(column) * b;
    with_matrices(column, [&](const auto* m, const auto* d, const auto* k) {
      for (int i = 0; i < b; ++i)
        for (int j = 0; j < b; ++j) {
          const int at = i + b * j;
          pivot(column)[i * b + j] = held[i] != 0 || held[j] != 0 ? Rows::fill(i == j ? 1.0 : 0.0)
                                                                  : m[at] + rate * d[at] + displacement * k[at];
        }
    });
  }
  /// Subtracts the contribution of an eliminated neighbour from the diagonal block.
  void subtract_neighbour(int pair, int further, int nearer, Row rate, Row displacement) const {
    Row coupling[most_block * most_block];  // coupling of the nearer column's rows with the further column
    couple(pair, nearer > further, rate, displacement, coupling);
    const Row* F = factor(pair);
    Row* to = pivot(nearer);
    for (int i = 0; i < b; ++i)
      for (int j = 0; j < b; ++j)
        for (int k = 0; k < b; ++k) to[i * b + j] -= F[i * b + k] * coupling[j * b + k];
  }
  /// Eliminates the further column after its own further neighbour, if it has one.
  void eliminate(int pair, int further, int nearer, Row rate, Row displacement) const {
    const int before = 2 * further - nearer;
    set_diagonal(further, rate, displacement);
    if (before >= 0 && before < t.columns)
      subtract_neighbour(before < further ? before : further, before, further, rate, displacement);
    invert_pivot(further);
    const Row* inverse = pivot(further);
    Row *to = factor(pair), coupling[most_block * most_block];
    couple(pair, nearer > further, rate, displacement, coupling);
    for (int i = 0; i < b; ++i)
      for (int j = 0; j < b; ++j) {
        Row sum{};
        for (int k = 0; k < b; ++k) sum += coupling[i * b + k] * inverse[k * b + j];
        to[i * b + j] = sum;
      }
  }
  void invert_middle(Row rate, Row displacement) const {
    const int m = t.middle;
    set_diagonal(m, rate, displacement);
    if (m > 0) subtract_neighbour(m - 1, m - 1, m, rate, displacement);
    if (m + 1 < t.columns) subtract_neighbour(m, m + 1, m, rate, displacement);
    invert_pivot(m);
  }
  void move_middle(int to, Row rate, Row displacement) const {
    for (int c = t.middle; c < to; ++c) eliminate(c, c, c + 1, rate, displacement);
    for (int c = t.middle; c > to; --c) eliminate(c - 1, c, c - 1, rate, displacement);
    t.middle = to;
    invert_middle(rate, displacement);
  }

  /// Calls use(M, C, K) with the blocks of a column.
  template <class Use>
  void with_matrices(int column, Use use) const {
    const ColumnMatrices& of = t.column[column];
    of.rows ? use(rows(of.mass), rows(of.damping), rows(of.stiffness)) : use(of.mass, of.damping, of.stiffness);
  }

  /// y -= A x. Each block is read once: the products of a coupling block with both of its columns are computed
  /// together.
  void subtract_product(const double* ColumnMatrices::*A, const Row* x, Row* y) const {
    Row of_before[most_block] = {};  // contribution of the column before
    for (int c = 0; c < t.columns; ++c) {
      const auto subtract_column = [&](const auto* own) {
        const auto* next = own + bb;
        const Row* of = x + static_cast<long>(c) * b;
        Row sum[most_block];
        for (int i = 0; i < b; ++i) {
          sum[i] = of_before[i];
          for (int j = 0; j < b; ++j) sum[i] += own[i + b * j] * of[j];
        }
        if (c + 1 < t.columns)
          for (int j = 0; j < b; ++j) {
            of_before[j] = Row{};
            for (int i = 0; i < b; ++i) {
              sum[i] += next[i + b * j] * of[b + j];
              of_before[j] += next[i + b * j] * of[i];
            }
          }
        for (int i = 0; i < b; ++i) y[static_cast<long>(c) * b + i] -= sum[i];
      };
      t.column[c].rows ? subtract_column(rows(t.column[c].*A)) : subtract_column(t.column[c].*A);
    }
  }

  void invert_pivot(int column) const {
    invert(pivot(column), b);
    for (int j = 0; j < b; ++j)
      if (t.held[static_cast<long>(column) * b + j] != 0) pivot(column)[j * b + j] = Row{};
  }

  /// Stores the coupling block of J for the pair, by rows: the rows of the right column with the left column, or the
  /// reverse.
  void couple(int pair, bool rows_of_right, Row rate, Row displacement, Row* to) const {
    const char* held = t.held + static_cast<long>(pair) * b;
    with_matrices(pair, [&](const auto* m, const auto* d, const auto* k) {
      for (int i = 0; i < b; ++i)  // unknown i of the left column
        for (int j = 0; j < b; ++j) {
          const int at = bb + i + b * j;
          to[rows_of_right ? j * b + i : i * b + j] =
              held[i] != 0 || held[b + j] != 0 ? Row{} : m[at] + rate * d[at] + displacement * k[at];
        }
    });
  }

  /// Computes the inverse of J within the band, column by column from the middle, at the elements' transverse unknowns.
  void find_compliance(Row displacement) const {
    Row* inverse =
        rows(t.inverse);  // blocks of all columns, then blocks of all pairs with the rows of the nearer column
    Row* const pairs = inverse + static_cast<long>(t.columns) * bb;
    for (int i = 0; i < bb; ++i) inverse[static_cast<long>(t.middle) * bb + i] = pivot(t.middle)[i];
    outwards(0, t.columns - 1, t.middle, t.middle, [&](int pair, int further, int nearer) {
      const Row *F = factor(pair), *P = pivot(further), *Z = inverse + static_cast<long>(nearer) * bb;
      Row *own = inverse + static_cast<long>(further) * bb, *with = pairs + static_cast<long>(pair) * bb;
      for (int i = 0; i < b; ++i)
        for (int j = 0; j < b; ++j) {
          Row sum{};
          for (int k = 0; k < b; ++k) sum -= Z[i * b + k] * F[k * b + j];
          with[i * b + j] = sum;
        }
      for (int i = 0; i < b; ++i)
        for (int j = 0; j < b; ++j) {
          Row sum = P[i * b + j];
          for (int k = 0; k < b; ++k) sum -= F[k * b + i] * with[k * b + j];
          own[i * b + j] = sum;
        }
    });
    const int* o = t.transverse;
    for (int e = 0; e < t.elements; ++e) {
      const int c = t.first_column[e];
      const Row *left = inverse + static_cast<long>(c) * bb, *right = left + bb,
                *with = pairs + static_cast<long>(c) * bb;
      const bool of_right = c < t.middle;     // whether the block `with` has the rows of the right column
      const auto entry = [&](int i, int j) {  // i <= j among v1, theta1, v2, theta2
        if (j < 2) return left[o[i] * b + o[j]];
        if (i >= 2) return right[o[i - 2] * b + o[j - 2]];
        return of_right ? with[o[j - 2] * b + o[i]] : with[o[i] * b + o[j - 2]];
      };
      Row* to = rows(t.compliance) + 10L * e;
      for (int i = 0, n = 0; i < 4; ++i)
        for (int j = i; j < 4; ++j, ++n) to[n] = (i == j ? 1.0 : 2.0) * displacement * entry(i, j);
    }
  }
};

}  // namespace
}  // namespace traverse::engine
