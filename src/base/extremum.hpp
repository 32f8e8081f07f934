// Extreme values of sampled curves, and the extremum of a smooth curve between its samples. `Value` is a number, or a
// SIMD vector with one curve in each lane. Kernels include this file too, therefore it uses an unnamed namespace
// (engine/train_kernel.hpp).
#pragma once

#include <cstddef>

namespace traverse::base {

/// An extreme value with its time and the index of its curve.
struct Extreme {
  double value = 0.0, time = 0.0;  // s
  std::size_t place = 0;           // index of a probe, wheel or vehicle

  /// Replaces this extreme if the other value is larger.
  void raise(double other, double when, std::size_t which) {
    if (other > value) *this = {other, when, which};
  }
};

inline constexpr int samples_kept = 5;  // number of stored samples of a curve, the latest one last

namespace {

/// The samples that determine the extremum of a curve at or near one of them. Steps that end at events may have any
/// length: if an interval is more than most_uneven times as long as the next one, the slope over the shorter one is
/// determined by a jump or by rounding.
struct Stencil {
  static constexpr double most_uneven = 4.0;
  int left = 0, right = 0;
  bool three = false, five = false;  // a parabola through left, i and right; a polynomial of degree four through all

  /// x: times or distances of the samples; i: the sample that is extreme between its neighbours; oldest: the first
  /// sample.
  Stencil(const double* x, int i, int oldest) : left(i - 1), right(i + 1) {
    if (left < oldest) return;
    const auto interval = [=](int a, int b) { return x[b] - x[a]; };
    five = i == 2 && oldest == 0 && comparable(interval(0, 1), interval(1, 2)) &&
           comparable(interval(1, 2), interval(2, 3)) && comparable(interval(2, 3), interval(3, 4));
    while (left > oldest && most_uneven * interval(left, i) < interval(i, i + 1)) --left;
    while (right + 1 < samples_kept && most_uneven * interval(i, right) < interval(i - 1, i)) ++right;
    three = comparable(interval(left, i), interval(i, right));
  }
  static bool comparable(double a, double b) { return a <= most_uneven * b && b <= most_uneven * a; }
};

/// The extremum of the curve y near sample i, and its distance `offset` behind this sample. It uses five samples (i =
/// 2) or three; for a wave of angular frequency w, sampled every h, the error is (w h)^6/200 or (w h)^4/40.
template <class Value>
inline Value extreme_between(const double* x, const Value* y, int i, const Stencil& by, bool five, Value& offset) {
  constexpr int iterations = 3;
  const int l = five ? i - 1 : by.left, r = five ? i + 1 : by.right;
  const double before = x[i] - x[l], after = x[r] - x[i];
  const Value middle = y[i], rise = (middle - y[l]) / before, fall = (y[r] - middle) / after;
  const Value slope = (rise * after + fall * before) / (before + after), quadratic = (fall - rise) / (before + after);
  offset = -0.5 * slope / quadratic;  // vertex of the parabola slope s + quadratic s^2 above the middle
  const Value of_three = middle + 0.5 * slope * offset;
  if (!five) return of_three;
  // The curve above the parabola is (s - s1) s (s - s3) (c + d (s - s0)), which interpolates the outer two samples too.
  const double s0 = x[0] - x[2], s1 = -before, s3 = after, s4 = x[4] - x[2];
  const auto cubic_factor = [&](double s, Value value) {
    return (value - middle - s * (slope + quadratic * s)) / ((s - s1) * s * (s - s3));
  };
  const Value c = cubic_factor(s0, y[0]), d = (cubic_factor(s4, y[4]) - c) / (s4 - s0), e = c - d * s0;
  const Value first = slope + e * (s1 * s3), second = quadratic - e * (s1 + s3) + d * (s1 * s3),
              third = e - d * (s1 + s3);
  Value s = offset;
  for (int k = 0; k < iterations; ++k)
    s -= (first + s * (2.0 * second + s * (3.0 * third + s * 4.0 * d))) /
         (2.0 * second + s * (6.0 * third + s * 12.0 * d));
  const auto inside = (s >= s1) & (s <= s3);
  offset = inside ? s : offset;
  return inside ? middle + s * (first + s * (second + s * (third + s * d))) : of_three;
}

/// The extreme value of a curve M that follows a smooth curve by M + lag dM/dt, between two samples with values and
/// rates:
///
///   M = start + p s + q s^2 + k lag (exp(-s/lag) - 1)
///
/// The rate changes its sign between the samples. `delay` becomes the time from the first sample to the extremum.
inline double extreme_of_lagging(double h, double start, double end, double rate, double end_rate, double lag,
                                 double& delay) {
  constexpr int bisections = 40;
  lag = lag < 100.0 * h ? lag : 100.0 * h;
  const double decay = __builtin_exp(-h / lag), decayed = 1.0 - decay;
  const double k = (end - start - 0.5 * h * (rate + end_rate)) / (0.5 * h * (1.0 + decay) - lag * decayed);
  const double p = rate + k, q = 0.5 * (end_rate - rate - k * decayed) / h;
  double from = 0.0, to = h;
  for (int i = 0; i < bisections; ++i) {
    const double s = 0.5 * (from + to);
    ((p + 2.0 * q * s - k * __builtin_exp(-s / lag)) * rate > 0.0 ? from : to) = s;
  }
  delay = from;
  return start + from * (p + q * from) - k * lag * (1.0 - __builtin_exp(-from / lag));
}

}  // namespace
}  // namespace traverse::base
