// Extreme values of sampled curves, and where a smooth curve has them between its samples: of one curve, or of one in
// each lane of a vector of numbers (then `Value` is that vector, and everything happens lane by lane). As kernels use
// it too, it is in an unnamed namespace (engine/train_kernel.hpp).
#pragma once

#include <cstddef>

namespace traverse::base {

/// An extreme value, when it was reached, and of which curve.
struct Extreme {
  double value = 0.0, time = 0.0;  // s
  std::size_t place = 0;           // probe, wheel, vehicle

  /// Becomes this one where it is greater.
  void raise(double other, double when, std::size_t which) {
    if (other > value) *this = {other, when, which};
  }
};

inline constexpr int samples_kept = 5;  // of a curve, the latest at the end

namespace {

/// Which of the latest samples tell the extreme of a curve at or near one of them. Steps that end at events may be of
/// any length: where one interval is more than so many times as long as the next, the slope over the shorter one is
/// made by a jump or by rounding.
struct Stencil {
  static constexpr double most_uneven = 4.0;
  int left = 0, right = 0;
  bool three = false, five = false;  // a parabola through left, i and right; a curve of fourth degree through all

  /// x: of the samples (a time or a way); i: the one that is extreme between its neighbours; oldest: the first one.
  Stencil(const double* x, int i, int oldest) : left(i - 1), right(i + 1) {
    if (left < oldest) return;
    const auto apart = [=](int a, int b) { return x[b] - x[a]; };
    five = i == 2 && oldest == 0 && alike(apart(0, 1), apart(1, 2)) && alike(apart(1, 2), apart(2, 3)) &&
           alike(apart(2, 3), apart(3, 4));
    while (left > oldest && most_uneven * apart(left, i) < apart(i, i + 1)) --left;
    while (right + 1 < samples_kept && most_uneven * apart(i, right) < apart(i - 1, i)) ++right;
    three = alike(apart(left, i), apart(i, right));
  }
  static bool alike(double a, double b) { return a <= most_uneven * b && b <= most_uneven * a; }
};

/// The extreme of the curve y near sample i, and how far behind that it is. By five samples (i = 2) or three; of a wave
/// of angular frequency w, sampled every h, they leave an error of (w h)^6/200 and (w h)^4/40.
template <class Value>
inline Value extreme_between(const double* x, const Value* y, int i, const Stencil& by, bool five, Value& behind) {
  constexpr int iterations = 3;
  const int l = five ? i - 1 : by.left, r = five ? i + 1 : by.right;
  const double before = x[i] - x[l], after = x[r] - x[i];
  const Value middle = y[i], rise = (middle - y[l]) / before, fall = (y[r] - middle) / after;
  const Value slope = (rise * after + fall * before) / (before + after), bend = (fall - rise) / (before + after);
  behind = -0.5 * slope / bend;  // of the parabola, slope s + bend s^2 above the middle
  const Value of_three = middle + 0.5 * slope * behind;
  if (!five) return of_three;
  // Above the parabola by (s - s1) s (s - s3) (c + d (s - s0)), so that it meets the outer two as well.
  const double s0 = x[0] - x[2], s1 = -before, s3 = after, s4 = x[4] - x[2];
  const auto missed = [&](double s, Value value) {
    return (value - middle - s * (slope + bend * s)) / ((s - s1) * s * (s - s3));
  };
  const Value c = missed(s0, y[0]), d = (missed(s4, y[4]) - c) / (s4 - s0), e = c - d * s0;
  const Value first = slope + e * (s1 * s3), second = bend - e * (s1 + s3) + d * (s1 * s3), third = e - d * (s1 + s3);
  Value s = behind;
  for (int k = 0; k < iterations; ++k)
    s -= (first + s * (2.0 * second + s * (3.0 * third + s * 4.0 * d))) /
         (2.0 * second + s * (6.0 * third + s * 12.0 * d));
  const auto inside = (s >= s1) & (s <= s3);
  behind = inside ? s : behind;
  return inside ? middle + s * (first + s * (second + s * (third + s * d))) : of_three;
}

/// A curve that follows a smooth one by M + lag dM/dt, between two samples with values and rates:
///
///   M = start + p s + q s^2 + k lag (exp(-s/lag) - 1)
///
/// whose rate changes its sign. Its extreme value, and how long after the first sample.
inline double extreme_of_lagging(double h, double start, double end, double rate, double end_rate, double lag,
                                 double& later) {
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
  later = from;
  return start + from * (p + q * from) - k * lag * (1.0 - __builtin_exp(-from / lag));
}

}  // namespace
}  // namespace traverse::base
