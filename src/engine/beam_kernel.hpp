// The structure's side of a stage (batch_task.hpp): J a = P + forces - C w~ - K v~ with J = M + rate C + displacement K
// = L D L^T in every lane, from w = w~ + rate a and v = v~ + displacement a.
//
// The factorisation goes unknown by unknown in the order of structure_lanes.hpp, and columns are eliminated from both
// ends to the middle column. The contact forces change from pass to pass. In each pass only the window of columns under
// the wheels is solved; the columns outside it are eliminated once before the passes of a stage, and solved after them.
// If the window has left the middle, the middle is moved to it. All functions of the kernels must have internal linkage
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

namespace {

template <int Size>
struct BeamRows : BeamFactor<Size> {
  using Factor = BeamFactor<Size>;
  using Factor::b;
  using Factor::t;
  explicit BeamRows(BeamTask& task) : Factor{task} {}

  /// Sets the window to the columns under wheels.
  void set_window(const TrainTask& train, Row rate, Row displacement) const {
    constexpr int worth_moving = 32;
    int first = t.columns, last = -1;
    for (const SurfacePatch& p : train.patch)
      for (int at = 0; at < train.wheels * lanes; ++at) {
        if (p.slot[at] == train.ground) continue;
        const int column = column_of(p.slot[at]);
        first = column < first ? column : first;
        last = column + 1 > last ? column + 1 : last;
      }
    if (t.lever != nullptr) list_touched(train);
    if (last < 0) first = last = t.middle;
    t.first = first < t.middle ? first : t.middle;
    t.last = last > t.middle ? last : t.middle;
    if (t.last - t.first <= 2 * (last - first) + worth_moving) return;
    t.first = first;
    t.last = last;
    Factor::move_middle((first + last) / 2, rate, displacement);
  }

  /// Eliminates the columns outside the window.
  void begin_passes() const {
    Row* const r = rows(t.residual);
    Factor::inwards(0, t.columns - 1, t.first, t.last,
                    [&](int further, int nearer) { Factor::forward(further, nearer, r); });
  }
  void clear_loads() const {
    for (int i = t.first * b; i < (t.last + 1) * b; ++i) rows(t.work)[i] = rows(t.residual)[i];
    for_touched([&](int /*first*/, Row* /*motion*/, Row* load) {
      for (int k = 0; k < t.values; ++k) load[k] = Row{};
    });
  }
  /// Solves the window under the present forces, in open lanes.
  void solve(Row displacement, RowMask open) const {
    Row *x = rows(t.work), *solution = rows(t.solution), *v = rows(t.v_stage);
    for_touched([&](int first, Row* /*motion*/, Row* load) {
      for (int k = 0; k < t.values; ++k) x[first + t.place[k]] += load[k];
      for (int k = 0; k < 4; ++k) x[first + t.twist[k]] += row(t.lever) * load[transverse_value(k)];
    });
    Factor::inwards(t.first, t.last, t.middle, t.middle,
                    [&](int further, int nearer) { Factor::forward(further, nearer, x); });
    Factor::forward(t.middle, Factor::none, x);
    Factor::backward(t.middle, Factor::none, x, x);
    Factor::outwards(t.first, t.last, t.middle, t.middle,
                     [&](int further, int nearer) { Factor::backward(further, nearer, x, x); });
    for (int i = t.first * b; i < (t.last + 1) * b; ++i) {
      solution[i] = open ? x[i] : solution[i];
      v[i] = rows(t.v_predicted)[i] + displacement * solution[i];
    }
    for_touched([&](int first, Row* motion, Row* /*load*/) {
      for (int k = 0; k < t.values; ++k) motion[k] = v[first + t.place[k]];
      for (int k = 0; k < 4; ++k) motion[transverse_value(k)] += row(t.lever) * v[first + t.twist[k]];
    });
  }
  /// Solves the columns outside the window, then computes the accelerations of all.
  void end_passes(const TrainTask& train, int stage) const {
    Row *const x = rows(t.solution), *const r = rows(t.residual), *const a = rows(t.a[stage + 1]);
    const Row *const w = rows(t.w_predicted), alpha = shift(row(train.stage[stage].rate));
    const auto accelerate = [&](int first, int last) {
      if (!t.proportional) return;  // x is a
      for (int i = first * b; i < (last + 1) * b; ++i) a[i] = x[i] - alpha * w[i];
    };
    accelerate(t.first, t.last);
    Factor::outwards(0, t.columns - 1, t.first, t.last, [&](int further, int nearer) {
      Factor::backward(further, nearer, r, x);
      accelerate(further, further);
    });
  }

  /// r with J x = r + forces. With damping C = a M + b K no product with C is needed: with alpha = a/(1 + rate a)
  ///
  ///   J (acceleration + alpha w~) = P + forces - K (v~ + (b - alpha (displacement + rate b)) w~)
  ///
  /// Then x is the acceleration plus alpha w~, and v~ is reduced accordingly. Otherwise x is the acceleration, and
  /// alpha is not used.
  void find_residual(const TrainTask& train, int stage) const {
    const StageRows& rule = train.stage[stage];
    Row *const v = rows(t.v_predicted), *const w = rows(t.w_predicted), *const u = t.proportional ? rows(t.work) : v;
    const Row rate = row(rule.rate), displacement = row(rule.displacement), by_stiffness = row(t.by_stiffness),
              alpha = shift(rate), of_w = by_stiffness - alpha * (displacement + rate * by_stiffness);
    if (!t.proportional) t.solution = t.a[stage + 1];
    constexpr int together = 24;  // unknowns whose numbers stay in the processor's nearest memory
    for (int from = 0, done = 0; from < t.unknowns; from += together) {
      const int n = t.unknowns - from < together ? t.unknowns - from : together, past = from + n;
      combine(stage + 1, rule, from, n, t.v, t.w, t.a, v + from, w + from);
      for (int i = from; t.proportional && i < past; ++i) {
        u[i] = v[i] + of_w * w[i];
        v[i] -= displacement * alpha * w[i];
      }
      const int known = past == t.unknowns ? past : past / b * b - b;  // a residual needs the next column's v~ and w~
      if (known > done) store_residual(done, known, u, w);
      done = known;
    }
  }

 private:
  /// The column of the first node of an element with this slot.
  int column_of(int slot) const {
    return t.lever == nullptr ? slot / lanes / b : t.first_column[(slot / lanes - t.track_row) / t.values];
  }
  /// The value of an element's track among v1, theta1, v2, theta2.
  int transverse_value(int k) const { return (k / 2 + 1) * t.values / 2 - 2 + k % 2; }
  void list_touched(const TrainTask& train) const {
    t.touched_count = 0;
    for (const SurfacePatch& p : train.patch)
      for (int at = 0; at < train.wheels * lanes; ++at) {
        if (p.slot[at] == train.ground) continue;
        const int element = (p.slot[at] / lanes - t.track_row) / t.values;
        int i = 0;
        while (i < t.touched_count && t.touched[i] != element) ++i;
        if (i == t.touched_count) t.touched[t.touched_count++] = element;
      }
  }
  /// Calls use(first unknown, motion of the track, load on it) for the elements under wheels of a track beside the
  /// axis.
  template <class Use>
  void for_touched(Use use) const {
    if (t.lever == nullptr) return;
    for (int i = 0; i < t.touched_count; ++i) {
      const int element = t.touched[i], own = t.track_row + element * t.values;
      use(t.first_column[element] * b, rows(t.v_stage) + own, rows(t.work) + own);
    }
  }
  Row shift(Row rate) const { return row(t.by_mass) / (1.0 + rate * row(t.by_mass)); }

  /// The residual P - K v - C w of the unknowns from `first` to before `past`; without C w if damping is proportional.
  void store_residual(int first, int past, const Row* v, const Row* w) const {
    Row* const r = rows(t.residual);
    for (int i = first; i < past; ++i) r[i] = t.shared ? Rows::fill(t.dead[i]) : rows(t.dead)[i];
    subtract_product<double>(first, past, t.equal, t.equal.stiffness, v, r);
    if (!t.shared) subtract_product<Row>(first, past, t.different, t.different.stiffness, v, r);
    if (t.proportional) return;
    subtract_product<double>(first, past, t.equal, t.equal.damping, w, r);
    if (!t.shared) subtract_product<Row>(first, past, t.different, t.different.damping, w, r);
  }

  /// y -= A x, for the same unknowns.
  template <class Entry>
  static void subtract_product(int first, int past, const MatrixEntries& of, const double* A, const Row* x, Row* y) {
    const int *const begin = of.begin, *const unknown = of.unknown, *const value = of.value;
    const Entry* const a = entries<Entry>(A);
    for (int i = first, e = begin[first]; i < past; ++i) {
      Row sum = y[i];
      for (const int end = begin[i + 1]; e < end; ++e) sum -= a[value[e]] * x[unknown[e]];
      y[i] = sum;
    }
  }
};

}  // namespace

}  // namespace traverse::engine
