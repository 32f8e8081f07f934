// The structure's side of a stage (batch_task.hpp): J a = P + forces - C w~ - K v~ with J = M + rate C + displacement
// K, factorised in every lane (beam_factor.hpp), from w = w~ + rate a and v = v~ + displacement a.
//
// The contact forces change from pass to pass. In each pass only the window of columns under the wheels is solved; the
// columns outside it are eliminated once before the passes of a stage, and solved after them. If the window has left
// the middle, the middle is moved to it.
#pragma once

#include "engine/beam_factor.hpp"

namespace traverse::engine {
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
