// The structure's side of a stage (beam_task.hpp): J a = P + forces - C w~ - K v~ with J = M + rate C + displacement K,
// from w = w~ + rate a and v = v~ + displacement a.
//
// Elimination from both ends to the column in the middle keeps two chains of products busy. As all kernels it is seen
// by no linker (train_kernel.hpp).
#pragma once

#include "engine/beam_task.hpp"
#include "engine/train_vehicles.hpp"

namespace traverse::engine {
namespace {

/// For blocks of `Size` unknowns; 0: of any size.
template <int Size>
struct BeamRows {
  const BeamTask& t;
  const int b = Size > 0 ? Size : t.block, bb = b * b, middle = t.columns / 2;

  Row* pivot(int column) const { return rows(t.pivot) + static_cast<long>(column) * bb; }
  /// Of the columns `pair` and pair + 1: rows of the one nearer to the middle.
  Row* factor(int pair) const { return rows(t.factor) + static_cast<long>(pair) * bb; }
  /// Calls use(pair, further, nearer) of all pairs from both ends to the middle.
  template <class Use>
  void inwards(Use use) const {
    const int left = middle, right = t.columns - 1 - middle;
    for (int k = 0; k < (left > right ? left : right); ++k) {
      if (k < left) use(k, k, k + 1);
      if (k < right) use(t.columns - 2 - k, t.columns - 1 - k, t.columns - 2 - k);
    }
  }
  /// The same from the middle to both ends.
  template <class Use>
  void outwards(Use use) const {
    const int left = middle, right = t.columns - 1 - middle;
    for (int k = (left > right ? left : right) - 1; k >= 0; --k) {
      if (k < left) use(k, k, k + 1);
      if (k < right) use(t.columns - 2 - k, t.columns - 1 - k, t.columns - 2 - k);
    }
  }

  void factorise(Row rate, Row displacement) const {
    for (int c = 0; c < t.columns; ++c) {
      const double *m = t.mass + 2L * c * bb, *d = t.damping + 2L * c * bb, *k = t.stiffness + 2L * c * bb;
      const char* held = t.held + static_cast<long>(c) * b;
      Row* to = pivot(c);
      for (int i = 0; i < b; ++i)
        for (int j = 0; j < b; ++j) {
          const int at = i + b * j;
          to[i * b + j] = held[i] != 0 || held[j] != 0 ? Rows::fill(i == j ? 1.0 : 0.0)
                                                       : m[at] + rate * d[at] + displacement * k[at];
        }
    }
    inwards([&](int pair, int further, int nearer) {
      invert_pivot(further);
      const Row* inverse = pivot(further);
      Row *to = factor(pair), *rest = pivot(nearer);
      Row coupling[most_block * most_block];  // of the nearer column's rows with the further one
      couple(pair, nearer > further, rate, displacement, coupling);
      for (int i = 0; i < b; ++i)
        for (int j = 0; j < b; ++j) {
          Row sum{};
          for (int k = 0; k < b; ++k) sum += coupling[i * b + k] * inverse[k * b + j];
          to[i * b + j] = sum;
        }
      for (int i = 0; i < b; ++i)
        for (int j = 0; j < b; ++j)
          for (int k = 0; k < b; ++k) rest[i * b + j] -= to[i * b + k] * coupling[j * b + k];
    });
    invert_pivot(middle);
    find_compliance(displacement);
  }

  /// x, in: forces, out: J^-1 of them.
  void solve(Row* x) const {
    inwards([&](int pair, int further, int nearer) {
      const Row *F = factor(pair), *from = x + static_cast<long>(further) * b;
      Row *to = x + static_cast<long>(nearer) * b, y[most_block];
      for (int i = 0; i < b; ++i) {
        y[i] = to[i];
        for (int k = 0; k < b; ++k) y[i] -= F[i * b + k] * from[k];
      }
      for (int i = 0; i < b; ++i) to[i] = y[i];
    });
    for (int c = 0; c < t.columns; ++c) {
      const Row* P = pivot(c);
      Row *of = x + static_cast<long>(c) * b, y[most_block];
      for (int i = 0; i < b; ++i) y[i] = of[i];
      for (int i = 0; i < b; ++i) {
        Row sum = P[i * b] * y[0];
        for (int k = 1; k < b; ++k) sum += P[i * b + k] * y[k];
        of[i] = sum;
      }
    }
    outwards([&](int pair, int further, int nearer) {
      const Row *F = factor(pair), *from = x + static_cast<long>(nearer) * b;
      Row *to = x + static_cast<long>(further) * b, y[most_block];
      for (int i = 0; i < b; ++i) {
        y[i] = to[i];
        for (int k = 0; k < b; ++k) y[i] -= F[k * b + i] * from[k];
      }
      for (int i = 0; i < b; ++i) to[i] = y[i];
    });
  }

  /// r with J x = r + forces. Damping C = a M + b K spares its product: with alpha = a/(1 + rate a)
  ///
  ///   J (acceleration + alpha w~) = P + forces - K (v~ + (b - alpha (displacement + rate b)) w~)
  ///
  /// and x is the acceleration and alpha w~, of which v~ is made less already. Else x is the acceleration.
  void find_residual(Row rate, Row displacement) const {
    Row *v = rows(t.v_predicted), *w = rows(t.w_predicted), *r = rows(t.residual), *u = rows(t.work);
    const int n = t.columns * b;
    for (int i = 0; i < n; ++i) r[i] = Rows::fill(t.dead[i]);
    if (!t.proportional) {
      subtract_product(t.stiffness, v, r);
      subtract_product(t.damping, w, r);
      return;
    }
    const Row alpha = shift(rate), of_w = t.by_stiffness - alpha * (displacement + rate * t.by_stiffness);
    for (int i = 0; i < n; ++i) {
      u[i] = v[i] + of_w * w[i];
      v[i] -= displacement * alpha * w[i];
    }
    subtract_product(t.stiffness, u, r);
  }
  /// The accelerations of x.
  void accelerations(Row rate, Row* a) const {
    const Row *w = rows(t.w_predicted), *x = rows(t.solution), alpha = t.proportional ? shift(rate) : Row{};
    for (int i = 0; i < t.columns * b; ++i) a[i] = x[i] - alpha * w[i];
  }

  static constexpr int most_block = Size > 0 ? Size : most_unknowns_of_a_column;

 private:
  Row shift(Row rate) const { return t.by_mass / (1.0 + rate * t.by_mass); }

  /// y -= A x.
  void subtract_product(const double* A, const Row* x, Row* y) const {
    for (int c = 0; c < t.columns; ++c) {
      const double *own = A + 2L * c * bb, *next = own + bb, *before = own - bb;
      const Row* of = x + static_cast<long>(c) * b;
      Row sum[most_block];
      for (int i = 0; i < b; ++i) {
        sum[i] = Row{};
        for (int j = 0; j < b; ++j) sum[i] += own[i + b * j] * of[j];
        for (int j = 0; j < b && c + 1 < t.columns; ++j) sum[i] += next[i + b * j] * of[b + j];
        for (int j = 0; j < b && c > 0; ++j) sum[i] += before[j + b * i] * of[j - b];
      }
      for (int i = 0; i < b; ++i) y[static_cast<long>(c) * b + i] -= sum[i];
    }
  }

  void invert_pivot(int column) const {
    invert(pivot(column), b);
    for (int j = 0; j < b; ++j)
      if (t.held[static_cast<long>(column) * b + j] != 0) pivot(column)[j * b + j] = Row{};
  }

  /// J of the pair, by rows: of the right column's with the left one, or the other way round.
  void couple(int pair, bool rows_of_right, Row rate, Row displacement, Row* to) const {
    const double* m = t.mass + (2L * pair + 1) * bb;
    const double *d = t.damping + (2L * pair + 1) * bb, *k = t.stiffness + (2L * pair + 1) * bb;
    const char* held = t.held + static_cast<long>(pair) * b;
    for (int i = 0; i < b; ++i)  // of the left column
      for (int j = 0; j < b; ++j) {
        const int at = i + b * j;
        to[rows_of_right ? j * b + i : i * b + j] =
            held[i] != 0 || held[b + j] != 0 ? Row{} : m[at] + rate * d[at] + displacement * k[at];
      }
  }

  /// The inverse of J within the band, column by column from the middle, at the elements' transverse unknowns.
  void find_compliance(Row displacement) const {
    Row* inverse = rows(t.inverse);  // of every column's block, then of every pair's: rows of the nearer one
    Row* const pairs = inverse + static_cast<long>(t.columns) * bb;
    for (int i = 0; i < bb; ++i) inverse[static_cast<long>(middle) * bb + i] = pivot(middle)[i];
    outwards([&](int pair, int further, int nearer) {
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
      const bool of_right = c < middle;       // the rows of `with`
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

/// use(BeamRows of the structure's blocks).
template <class Use>
void with_beam(const BeamTask& task, Use use) {
  if (task.block == 2)
    use(BeamRows<2>{task});
  else if (task.block == 3)
    use(BeamRows<3>{task});
  else
    use(BeamRows<0>{task});
}

}  // namespace
}  // namespace traverse::engine
