// The factor J = L D L^T of the structure in every lane, with J = M + rate C + displacement K (beam_kernel.hpp).
//
// The factorisation goes unknown by unknown in the order of structure_lanes.hpp, and columns are eliminated from both
// ends to the middle column, which can be moved. All functions of the kernels must have internal linkage
// (train_kernel.hpp).
#pragma once

#include "engine/batch_task.hpp"
#include "engine/train_vehicles.hpp"

namespace traverse::engine {
namespace {

/// Size: the unknowns of a column if all are linked (most_dense), otherwise 0.
template <int Size>
struct BeamFactor {
  BeamTask& t;
  const int b = Size > 0 ? Size : t.block;

  /// Calls use(further, nearer) for the pairs from column `left` on to `to_left`, and from `right` back to `to_right`,
  /// alternately: two independent chains of products use the processor better.
  template <class Use>
  void inwards(int left, int right, int to_left, int to_right, Use use) const {
    const int before = to_left - left, behind = right - to_right;
    for (int k = 0; k < (before > behind ? before : behind); ++k) {
      if (k < before) use(left + k, left + k + 1);
      if (k < behind) use(right - k, right - k - 1);
    }
  }
  /// The same pairs as inwards(), in the opposite order.
  template <class Use>
  void outwards(int left, int right, int to_left, int to_right, Use use) const {
    const int before = to_left - left, behind = right - to_right;
    for (int k = (before > behind ? before : behind) - 1; k >= 0; --k) {
      if (k < before) use(left + k, left + k + 1);
      if (k < behind) use(right - k, right - k - 1);
    }
  }

  void factorise(Row rate, Row displacement) const {
    inwards(0, t.columns - 1, t.middle, t.middle,
            [&](int further, int nearer) { eliminate(further, nearer, rate, displacement); });
    eliminate(t.middle, none, rate, displacement);
    find_compliance(displacement);
  }
  void move_middle(int to, Row rate, Row displacement) const {
    for (int c = t.middle; c < to; ++c) eliminate(c, c + 1, rate, displacement);
    for (int c = t.middle; c > to; --c) eliminate(c, c - 1, rate, displacement);
    t.middle = to;
    eliminate(to, none, rate, displacement);
  }

  static constexpr int none = -1;

  /// A column's step of x = L^-1 x, x being the first column's unknowns; nearer: the column eliminated next, or none.
  void forward(int column, int nearer, Row* x) const {
    Row* const own = x + column * b;
    subtract_earlier(column, own);
    if (nearer == none) return;
    const Row* F = pair_factor(column, nearer);
    Row* const to = x + nearer * b;
    if constexpr (Size > 0) {
      Row sum[Size];
      for (int i = 0; i < Size; ++i) sum[i] = to[i];
      for (int i = 0; i < Size; ++i)
        for (int k = 0; k < Size; ++k) sum[i] -= F[i * Size + k] * own[k];
      for (int i = 0; i < Size; ++i) to[i] = sum[i];
    } else {
      const PairOrder& p = pair_order(column, nearer);
      for (int i = 0, count = p.nearer_count; i < count; ++i) {
        Row sum = to[p.nearer[i]];
        for (int k = 0, terms = p.further_count; k < terms; ++k) sum -= *F++ * own[p.further[k]];
        to[p.nearer[i]] = sum;
      }
    }
  }
  /// A column's step of x = L^-T D^-1 y, after the step of the nearer one.
  void backward(int column, int nearer, const Row* y, Row* x) const {
    const Row* const D = rows(t.pivot) + column * b;
    Row of_size[Size > 0 ? Size : 1], *const to = x + column * b, *const own = Size > 0 ? of_size : to;
    for (int i = 0; i < b; ++i) own[i] = D[i] * y[column * b + i];
    if (nearer != none) subtract_nearer(column, nearer, x + nearer * b, own);
    subtract_later(column, own);
    for (int i = 0; i < Size; ++i) to[i] = own[i];
  }

 private:
  static constexpr int most = most_unknowns_of_a_column;
  static constexpr int dense_links = Size * (Size - 1) / 2, of_column = dense_links + Size * Size;

  const PairOrder& pair_order(int further, int nearer) const {
    return nearer > further ? *t.to_right[further] : *t.to_left[nearer];
  }
  Row* links(int column) const {
    return rows(t.factor) + (Size > 0 ? static_cast<long>(column) * of_column : t.link_begin[column]);
  }
  static int pair_of(int further, int nearer) { return nearer > further ? further : nearer; }
  Row* pair_factor(int further, int nearer) const {
    const int pair = pair_of(further, nearer);
    return rows(t.factor) + (Size > 0 ? static_cast<long>(pair) * of_column + dense_links : t.pair_begin[pair]);
  }

  /// The parts of both steps within a column; x: its unknowns.
  void subtract_earlier(int column, Row* x) const {
    const Row* L = links(column);
    if constexpr (Size > 0) {
      for (int i = 0; i < Size; ++i)
        for (int k = 0; k < i; ++k) x[i] -= *L++ * x[k];
    } else {
      const ColumnOrder& o = *t.order[column];
      for (int e = 0, count = o.links; e < count; ++e) x[o.later[e]] -= L[e] * x[o.earlier[e]];
    }
  }
  void subtract_later(int column, Row* x) const {
    const Row* L = links(column);
    if constexpr (Size > 0) {
      for (int i = Size - 1; i >= 0; --i)
        for (int k = 0; k < i; ++k) x[k] -= L[i * (i - 1) / 2 + k] * x[i];
    } else {
      const ColumnOrder& o = *t.order[column];
      for (int e = o.links - 1; e >= 0; --e) x[o.earlier[e]] -= L[e] * x[o.later[e]];
    }
  }
  void subtract_nearer(int further, int nearer, const Row* from, Row* x) const {
    const Row* F = pair_factor(further, nearer);
    if constexpr (Size > 0) {
      for (int i = 0; i < Size; ++i)
        for (int k = 0; k < Size; ++k) x[k] -= F[i * Size + k] * from[i];
    } else {
      const PairOrder& p = pair_order(further, nearer);
      for (int k = 0, count = p.further_count; k < count; ++k) {
        Row sum = x[p.further[k]];
        for (int i = 0, terms = p.nearer_count; i < terms; ++i) sum -= F[i * count + k] * from[p.nearer[i]];
        x[p.further[k]] = sum;
      }
    }
  }

  /// Adds the coefficients of J in the row of an unknown: to[j] for the unknowns of a column.
  template <class Entry>
  void add_row(const MatrixEntries& from, int unknown, int column, Row rate, Row displacement, Row* to) const {
    const Entry *m = entries<Entry>(from.mass), *c = entries<Entry>(from.damping), *k = entries<Entry>(from.stiffness);
    for (int e = from.begin[unknown]; e < from.begin[unknown + 1]; ++e) {
      const int j = from.unknown[e] - column * b, at = from.value[e];
      if (j < 0 || j >= b) continue;
      const Row damping = t.proportional ? row(t.by_mass) * m[at] + row(t.by_stiffness) * k[at] : spread(c[at]);
      to[j] += m[at] + rate * damping + displacement * k[at];
    }
  }
  void add_block(int of_rows, int column, Row rate, Row displacement, Row* to) const {
    for (int i = 0; i < b; ++i) {
      add_row<double>(t.equal, of_rows * b + i, column, rate, displacement, to + i * most);
      add_row<Row>(t.different, of_rows * b + i, column, rate, displacement, to + i * most);
    }
  }
  /// Subtracts what a column eliminated before leaves in its neighbour.
  void subtract_eliminated(int before, int column, Row* own) const {
    const PairOrder& p = pair_order(before, column);
    const Row* F = pair_factor(before, column);
    for (int k = 0; k < p.further_count; ++k) {
      const Row inverse = rows(t.pivot)[before * b + p.further[k]], d = inverse != 0.0 ? 1.0 / inverse : Row{};
      for (int i = 0; i < p.nearer_count; ++i)
        for (int j = 0; j < p.nearer_count; ++j)
          own[p.nearer[i] * most + p.nearer[j]] -= F[i * p.further_count + k] * d * F[j * p.further_count + k];
    }
  }
  /// Eliminates a column after its further neighbours, if it has them; nearer: the next one to be eliminated, or none.
  void eliminate(int column, int nearer, Row rate, Row displacement) const {
    Row own[most * most] = {}, with_nearer[most * most] = {};
    add_block(column, column, rate, displacement, own);
    if (nearer != none) add_block(nearer, column, rate, displacement, with_nearer);
    for (int before = column - 1; before <= column + 1; before += 2)
      if (before >= 0 && before < t.columns && before != nearer) subtract_eliminated(before, column, own);
    const ColumnOrder& o = *t.order[column];
    for (int i = 0; i < b; ++i) rows(t.pivot)[column * b + i] = Row{};
    for (int s = 0; s < o.count; ++s) {
      const int k = o.unknown[s];
      const Row coefficient = own[k * most + k], d = coefficient != 0.0 ? 1.0 / coefficient : Row{};  // 0: it is held
      rows(t.pivot)[column * b + k] = d;
      for (int r = s + 1; r < o.count; ++r) {
        const int i = o.unknown[r];
        const Row l = own[i * most + k] * d;
        for (int q = r; q < o.count; ++q) own[o.unknown[q] * most + i] -= own[o.unknown[q] * most + k] * l;
        for (int j = 0; j < b; ++j) with_nearer[j * most + i] -= with_nearer[j * most + k] * l;
      }
    }
    const auto of_factor = [&](const Row* J, int i, int k) { return J[i * most + k] * rows(t.pivot)[column * b + k]; };
    for (int e = 0; e < o.links; ++e) links(column)[e] = of_factor(own, o.later[e], o.earlier[e]);
    if (nearer == none) return;
    const PairOrder& p = pair_order(column, nearer);
    Row* F = pair_factor(column, nearer);
    for (int i = 0; i < p.nearer_count; ++i)
      for (int k = 0; k < p.further_count; ++k) *F++ = of_factor(with_nearer, p.nearer[i], p.further[k]);
  }

  /// (L D L^T)^-1 of a column alone, by rows.
  void find_own_inverse(int column, Row* to) const {
    for (int k = 0; k < b; ++k) {
      Row x[most] = {};
      x[k] = Rows::fill(1.0);
      subtract_earlier(column, x);
      for (int i = 0; i < b; ++i) x[i] *= rows(t.pivot)[column * b + i];
      subtract_later(column, x);
      for (int i = 0; i < b; ++i) to[i * b + k] = x[i];
    }
  }
  /// G = J_nf J_ff^-1, nearer rows by further columns, with J as it is when the further column is eliminated.
  void find_coupling(int further, int nearer, Row* G) const {
    const PairOrder& p = pair_order(further, nearer);
    const Row* F = pair_factor(further, nearer);
    for (int i = 0; i < p.nearer_count; ++i) {
      Row* const g = G + p.nearer[i] * most;
      for (int k = 0; k < p.further_count; ++k) g[p.further[k]] = *F++;
      subtract_later(further, g);
    }
  }
  /// Computes the inverse of J within the band, column by column from the middle, at the elements' transverse unknowns.
  void find_compliance(Row displacement) const {
    const int bb = b * b;
    Row* inverse =
        rows(t.inverse);  // blocks of all columns, then blocks of all pairs with the rows of the nearer column
    Row* const pairs = inverse + static_cast<long>(t.columns) * bb;
    find_own_inverse(t.middle, inverse + static_cast<long>(t.middle) * bb);
    outwards(0, t.columns - 1, t.middle, t.middle, [&](int further, int nearer) {
      const Row* Z = inverse + static_cast<long>(nearer) * bb;
      Row *own = inverse + static_cast<long>(further) * bb,
          *with = pairs + static_cast<long>(pair_of(further, nearer)) * bb;
      Row G[most * most] = {};
      find_coupling(further, nearer, G);
      for (int i = 0; i < b; ++i)
        for (int j = 0; j < b; ++j) {
          Row sum{};
          for (int k = 0; k < b; ++k) sum -= Z[i * b + k] * G[k * most + j];
          with[i * b + j] = sum;
        }
      find_own_inverse(further, own);
      for (int i = 0; i < b; ++i)
        for (int j = 0; j < b; ++j)
          for (int k = 0; k < b; ++k) own[i * b + j] -= G[k * most + i] * with[k * b + j];
    });
    const int* o = t.transverse;
    for (int e = 0; e < t.elements; ++e) {
      const int c = t.first_column[e];
      const Row *left = inverse + static_cast<long>(c) * bb, *right = left + bb,
                *with = pairs + static_cast<long>(c) * bb;
      const bool of_right = c < t.middle;  // whether the block `with` has the rows of the right column
      // i <= j: unknowns p and q at the nodes of i and j among v1, theta1, v2, theta2
      const auto entry = [&](int i, int j, int p, int q) {
        if (j < 2) return left[p * b + q];
        if (i >= 2) return right[p * b + q];
        return of_right ? with[q * b + p] : with[p * b + q];
      };
      Row* to = rows(t.compliance) + 10L * e;
      for (int i = 0, n = 0; i < 4; ++i)
        for (int j = i; j < 4; ++j, ++n) {
          const int p = o[i % 2], q = o[j % 2];
          Row sum = entry(i, j, p, q);
          if (t.lever != nullptr) {
            const Row lever = row(t.lever);
            const int p_twist = t.twist[i] % b, q_twist = t.twist[j] % b;
            sum += lever * (entry(i, j, p, q_twist) + entry(i, j, p_twist, q) + lever * entry(i, j, p_twist, q_twist));
          }
          to[n] = (i == j ? 1.0 : 2.0) * displacement * sum;
        }
    }
  }
};

}  // namespace
}  // namespace traverse::engine
