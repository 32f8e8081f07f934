// Where a smooth curve turns between its samples.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace traverse::app {

/// The latest samples of a curve, the last one at the end.
struct Samples {
  static constexpr std::size_t most = 5;
  std::array<double, most> time{}, value{};
  std::size_t count = 0;  // so many have come

  void push(double t, double y) {
    std::rotate(time.begin(), time.begin() + 1, time.end());
    std::rotate(value.begin(), value.begin() + 1, value.end());
    time.back() = t;
    value.back() = y;
    ++count;
  }
};

struct Turn {
  double value = 0.0, time = 0.0;
};

/// A curve about a sample i > 0 that is extreme between its neighbours is slope s + bend s^2 above it, s after it.
struct Parabola {
  double slope, bend;

  Parabola(const Samples& samples, std::size_t i) {
    const auto& [t, y, count] = samples;
    const double before = t[i] - t[i - 1], after = t[i + 1] - t[i];
    const double rise = (y[i] - y[i - 1]) / before, fall = (y[i + 1] - y[i]) / after;
    slope = (rise * after + fall * before) / (before + after);
    bend = (fall - rise) / (before + after);
  }
  double top() const { return -0.5 * slope / bend; }
};

/// The turn of the parabola through three samples, that at i the middle one and extreme: of a wave of angular frequency
/// w and samples h apart it is off by (w h)^4/40.
inline Turn turn_of_three(const Samples& samples, std::size_t i) {
  const Parabola parabola(samples, i);
  const double top = parabola.top();
  return {samples.value[i] + 0.5 * parabola.slope * top, samples.time[i] + top};
}

/// The turn of the curve of fourth degree through five samples, the middle one extreme: off by (w h)^6/200. Where one
/// interval is more than four times another, that of the middle three.
inline Turn turn_of_five(const Samples& samples) {
  constexpr std::size_t middle = 2;
  constexpr double alike = 4.0;
  constexpr int iterations = 3;
  const auto& [t, y, count] = samples;
  std::array<double, 4> interval{};
  for (std::size_t i = 0; i < 4; ++i) interval[i] = t[i + 1] - t[i];
  const auto [shortest, longest] = std::minmax_element(interval.begin(), interval.end());
  const Parabola inner(samples, middle);
  if (*longest > alike * *shortest) return turn_of_three(samples, middle);
  // Above the parabola by (s - s1) s (s - s3) (c + d (s - s0)), so that it meets the outer two as well.
  const double s0 = t[0] - t[2], s1 = t[1] - t[2], s3 = t[3] - t[2], s4 = t[4] - t[2];
  const auto missed = [&](double s, double value) {
    return (value - y[2] - s * (inner.slope + inner.bend * s)) / ((s - s1) * s * (s - s3));
  };
  const double c = missed(s0, y[0]), d = (missed(s4, y[4]) - c) / (s4 - s0), e = c - d * s0;
  const double first = inner.slope + e * s1 * s3, second = inner.bend - e * (s1 + s3) + d * s1 * s3,
               third = e - d * (s1 + s3);
  double s = inner.top();
  for (int k = 0; k < iterations; ++k)
    s -= (first + s * (2.0 * second + s * (3.0 * third + s * 4.0 * d))) /
         (2.0 * second + s * (6.0 * third + s * 12.0 * d));
  if (!(s >= s1 && s <= s3)) return turn_of_three(samples, middle);
  return {y[2] + s * (first + s * (second + s * (third + s * d))), t[2] + s};
}

}  // namespace traverse::app
