// What the crossing of trains (crossing_kernel.hpp) is computed with, lane by lane: matrices, predictions of a method,
// oscillators, and lookups of what all lanes have in common. As all of a kernel it is seen by no linker.
#pragma once

#include "engine/lane.hpp"
#include "lanes/crossing_task.hpp"

namespace traverse::lanes {
namespace {

using engine::Lanes;
using engine::run_as_wide;
using engine::size_of_work;
using engine::take_from;

template <int W>
struct CrossingAlgebra : Lanes<W> {
  using Own = Lanes<W>;
  using Own::fill;
  using Own::lanes;
  using typename Own::Lane;

  // --- sums and matrices by rows
  // ----------------------------------------------------------------------------------------------

  /// The sum of term(i) for i below n, four at a time, which keep the processor busy.
  template <class Term>
  static Lane sum(int n, Term term) {
    Lane a{}, b{}, c{}, d{};
    int i = 0;
    for (; i + 4 <= n; i += 4) {
      a += term(i);
      b += term(i + 1);
      c += term(i + 2);
      d += term(i + 3);
    }
    for (; i < n; ++i) a += term(i);
    return (a + b) + (c + d);
  }
  /// The sum of a_i b_i.
  template <class Number>
  static Lane dot(const Number* a, const Lane* b, int n) {
    return sum(n, [=](int i) { return a[i] * b[i]; });
  }

  /// In place, without pivots: of matrices whose symmetric part is positive.
  static void invert(Lane* A, int n) {
    for (int k = 0; k < n; ++k) {
      const Lane pivot = 1.0 / A[k * n + k];
      for (int j = 0; j < n; ++j) A[k * n + j] *= pivot;
      A[k * n + k] = pivot;
      for (int i = 0; i < n; ++i) {
        if (i == k) continue;
        const Lane factor = A[i * n + k];
        A[i * n + k] = Lane{};
        for (int j = 0; j < n; ++j) A[i * n + j] -= factor * A[k * n + j];
      }
    }
  }

  /// y += sign A x for a matrix by rows; four rows at a time keep the processor busy.
  static void multiply(double sign, const Lane* A, int rows, int columns, const Lane* x, Lane* y) {
    int i = 0;
    for (; i + 4 <= rows; i += 4) {
      const Lane *A0 = A + i * columns, *A1 = A0 + columns, *A2 = A1 + columns, *A3 = A2 + columns;
      Lane y0{}, y1{}, y2{}, y3{};
      for (int k = 0; k < columns; ++k) {
        y0 += A0[k] * x[k];
        y1 += A1[k] * x[k];
        y2 += A2[k] * x[k];
        y3 += A3[k] * x[k];
      }
      y[i] += sign * y0;
      y[i + 1] += sign * y1;
      y[i + 2] += sign * y2;
      y[i + 3] += sign * y3;
    }
    for (; i + 2 <= rows; i += 2) {
      const Lane *A0 = A + i * columns, *A1 = A0 + columns;
      Lane y0{}, y1{}, y2{}, y3{};
      int k = 0;
      for (; k + 2 <= columns; k += 2) {
        y0 += A0[k] * x[k];
        y1 += A1[k] * x[k];
        y2 += A0[k + 1] * x[k + 1];
        y3 += A1[k + 1] * x[k + 1];
      }
      for (; k < columns; ++k) {
        y0 += A0[k] * x[k];
        y1 += A1[k] * x[k];
      }
      y[i] += sign * (y0 + y2);
      y[i + 1] += sign * (y1 + y3);
    }
    for (; i < rows; ++i) {
      Lane sum{};
      for (int k = 0; k < columns; ++k) sum += A[i * columns + k] * x[k];
      y[i] += sign * sum;
    }
  }

  /// L D L^T of a symmetric matrix in place, its lower half given: the pivots' inverses on the diagonal. scaled: n
  /// lanes of work.
  static void factorise(Lane* A, int n, Lane* scaled) {
    for (int j = 0; j < n; ++j) {
      const Lane inverse = 1.0 / A[j * n + j];
      A[j * n + j] = inverse;
      for (int i = j + 1; i < n; ++i) scaled[i] = A[i * n + j] * inverse;
      for (int i = j + 1; i < n; ++i) {
        Lane* row = A + i * n;
        const Lane entry = row[j];
        for (int k = j + 1; k <= i; ++k) row[k] -= entry * scaled[k];
      }
      for (int i = j + 1; i < n; ++i) A[i * n + j] = scaled[i];
    }
  }
  /// With these factors, x in and out.
  static void solve(const Lane* A, int n, Lane* x) {
    for (int k = 0; k < n; ++k)
      for (int i = k + 1; i < n; ++i) x[i] -= A[i * n + k] * x[k];
    for (int i = 0; i < n; ++i) x[i] *= A[i * n + i];
    for (int k = n - 1; k > 0; --k)
      for (int i = 0; i < k; ++i) x[i] -= A[k * n + i] * x[k];
  }

  // --- steps ---------------------------------------------------------------------------------------------------------

  /// What a method combines, for steps of this length.
  struct Rule {
    Lane w_in_v, a_in_v[most_kept], a_in_w[most_kept];
  };

  /// x~ and w~ of n coordinates from `Known` accelerations.
  template <int Known>
  static void predict(int n, const Rule& rule, const Lane* x, const Lane* w, Lane* const* a, int first, Lane* x_still,
                      Lane* w_still) {
    for (int i = 0; i < n; ++i) {
      Lane position = x[i] + rule.w_in_v * w[i], rate = w[i];
      for (int j = 0; j < Known; ++j) {
        position += rule.a_in_v[j] * a[j][first + i];
        rate += rule.a_in_w[j] * a[j][first + i];
      }
      x_still[i] = position;
      w_still[i] = rate;
    }
  }
  static void predict(int known, int n, const Rule& rule, const Lane* x, const Lane* w, Lane* const* a, int first,
                      Lane* x_still, Lane* w_still) {
    switch (known) {
      case 1:
        return predict<1>(n, rule, x, w, a, first, x_still, w_still);
      case 2:
        return predict<2>(n, rule, x, w, a, first, x_still, w_still);
      case 3:
        return predict<3>(n, rule, x, w, a, first, x_still, w_still);
      case 4:
        return predict<4>(n, rule, x, w, a, first, x_still, w_still);
      default:
        return predict<5>(n, rule, x, w, a, first, x_still, w_still);
    }
  }

  /// Where an oscillator u'' + c u' + k u = f0 + (f1 - f0) t/h is after h.
  struct Oscillation {
    double u, w;
  };
  static Oscillation oscillate(double k, double c, double h, double u0, double w0, double f0, double f1) {
    const double phase2 = k * h * h, lost = c * h;
    if (phase2 < 0.25 && lost < 0.5) {
      // u h^j/j! by the equation's derivatives, with no digits lost to differences.
      double a = u0, b = w0 * h, u = a + b, w = b;
      for (int j = 0; j < 24; ++j) {
        const double force = j == 0 ? f0 : j == 1 ? f1 - f0 : 0.0;
        const double next = (force * h * h - lost * (j + 1) * b - phase2 * a) / ((j + 1.0) * (j + 2.0));
        a = b;
        b = next;
        u += b;
        w += (j + 2) * b;
      }
      return {u, w / h};
    }
    const double B = (f1 - f0) / (h * k), A = (f0 - c * B) / k, sigma = 0.5 * c, square = k - sigma * sigma;
    double even = 0.0, odd = 0.0;
    if (square > 0.0) {
      const double damped = __builtin_sqrt(square), decay = __builtin_exp(-sigma * h);
      even = decay * __builtin_cos(damped * h);
      odd = decay * __builtin_sin(damped * h) / damped;
    } else {
      const double kappa = __builtin_sqrt(-square), slow = __builtin_exp((kappa - sigma) * h);
      const double ratio = __builtin_exp(-2.0 * kappa * h);
      even = 0.5 * slow * (1.0 + ratio);
      odd = kappa * h > 1e-8 ? 0.5 * slow * (1.0 - ratio) / kappa : slow * h;
    }
    const double u = u0 - A, w = w0 - B;
    return {A + B * h + (even + sigma * odd) * u + odd * w, B - k * odd * u + (even - sigma * odd) * w};
  }

  // --- what all lanes have in common ---------------------------------------------------------------------------------

  /// The influence of a unit force at x on so many channels, and by how much that on the first `modes` of them rises
  /// there, for each metre. False off the bridge.
  static bool influence_at(const TaskInfluence& line, double x, int* piece, int modes, int channels, double* g,
                           double* slope) {
    if (line.pieces == 0 || x < line.breaks[0] || x > line.breaks[line.pieces]) return false;
    while (*piece + 1 < line.pieces && x >= line.breaks[*piece + 1]) ++*piece;
    const double* c = line.coefficients + 4L * line.channels * *piece;
    const double d = x - line.breaks[*piece];
    const int n = line.channels;
    for (int i = 0; i < modes; ++i) {
      const double c1 = c[n + i], c2 = c[2 * n + i], c3 = c[3 * n + i];
      g[i] = c[i] + d * (c1 + d * (c2 + d * c3));
      slope[i] = c1 + d * (2.0 * c2 + 3.0 * d * c3);
    }
    for (int i = modes; i < channels; ++i) g[i] = c[i] + d * (c[n + i] + d * (c[2 * n + i] + d * c[3 * n + i]));
    return true;
  }

  /// By how much the influence on the first `modes` channels rises at x, which is on that piece, for each metre.
  static void influence_slope_at(const TaskInfluence& line, double x, int piece, int modes, double* slope) {
    const int n = line.channels;
    const double* c = line.coefficients + 4L * n * piece;
    const double d = x - line.breaks[piece];
    for (int i = 0; i < modes; ++i) slope[i] = c[n + i] + d * (2.0 * c[2 * n + i] + 3.0 * d * c[3 * n + i]);
  }

  /// Height and slope of the track under a wheel at x.
  static void track_at(const TaskHeights& track, double x, Lane& height, Lane& slope) {
    height = slope = Lane{};
    if (track.stations == 0) return;
    double at = (x - track.start) / track.distance;
    const double last = static_cast<double>(track.stations - 1);
    at = at < 0.0 ? 0.0 : at > last ? last : at;
    long i = static_cast<long>(at);
    if (i > track.stations - 2) i = track.stations - 2;
    const double u = at - static_cast<double>(i), v = 1.0 - u, turn = 6.0 * u * v / track.distance;
    const double of_value[2] = {v * v * (1.0 + 2.0 * u), u * u * (1.0 + 2.0 * v)}, of_rise[2] = {v * v * u, -u * u * v};
    const double slope_of_rise[2] = {v * (1.0 - 3.0 * u) / track.distance, u * (1.0 - 3.0 * v) / track.distance};
    for (int k = 0; k < 2; ++k) {
      const long place = 2 * (i + k);
      const Lane value = track.shared ? fill(track.values[place]) : lanes(track.values)[place];
      const Lane rise = track.shared ? fill(track.values[place + 1]) : lanes(track.values)[place + 1];
      height += of_value[k] * value + of_rise[k] * rise;
      slope += (k == 0 ? -turn : turn) * value + slope_of_rise[k] * rise;
    }
  }
};

}  // namespace
}  // namespace traverse::lanes
