// Where a smooth curve turns between its samples.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace traverse::app {

/// The latest samples of a curve, the last one at the end; times in s.
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
  double value = 0.0, time = 0.0;  // s
};

/// Steps that end at events may be of any length. Beyond this ratio of intervals the shorter one says more of a jump or
/// of rounding than of the slope.
inline constexpr double most_uneven = 4.0;

inline bool are_alike(double a, double b) { return std::max(a, b) <= most_uneven * std::min(a, b); }

/// The parabola through a sample i and one on either side of it is slope s + bend s^2 above that sample, s after it.
struct Parabola {
  double slope, bend;

  Parabola(const Samples& samples, std::size_t left, std::size_t i, std::size_t right) {
    const auto &t = samples.time, &y = samples.value;
    const double before = t[i] - t[left], after = t[right] - t[i];
    const double rise = (y[i] - y[left]) / before, fall = (y[right] - y[i]) / after;
    slope = (rise * after + fall * before) / (before + after);
    bend = (fall - rise) / (before + after);
  }
  double vertex() const { return -0.5 * slope / bend; }
};

/// The turn of the curve of fourth degree through five samples, of which the middle one is extreme.
inline Turn turn_of_five(const Samples& samples) {
  constexpr int iterations = 3;
  const auto &t = samples.time, &y = samples.value;
  const Parabola inner(samples, 1, 2, 3);
  // Above the parabola by (s - s1) s (s - s3) (c + d (s - s0)), so that it meets the outer two as well.
  const double s0 = t[0] - t[2], s1 = t[1] - t[2], s3 = t[3] - t[2], s4 = t[4] - t[2];
  const auto missed = [&](double s, double value) {
    return (value - y[2] - s * (inner.slope + inner.bend * s)) / ((s - s1) * s * (s - s3));
  };
  const double c = missed(s0, y[0]), d = (missed(s4, y[4]) - c) / (s4 - s0), e = c - d * s0;
  const double first = inner.slope + e * s1 * s3, second = inner.bend - e * (s1 + s3) + d * s1 * s3,
               third = e - d * (s1 + s3);
  double s = inner.vertex();
  for (int k = 0; k < iterations; ++k)
    s -= (first + s * (2.0 * second + s * (3.0 * third + s * 4.0 * d))) /
         (2.0 * second + s * (6.0 * third + s * 12.0 * d));
  if (!(s >= s1 && s <= s3)) return {y[2] + 0.5 * inner.slope * inner.vertex(), t[2] + inner.vertex()};
  return {y[2] + s * (first + s * (second + s * (third + s * d))), t[2] + s};
}

/// Where the curve turns about the sample i, which is extreme between its neighbours; smooth(a, b): whether it has no
/// kink from sample a to b. Of a wave of angular frequency w, sampled every h, five samples whose intervals are alike
/// make an error of (w h)^6/200, three of (w h)^4/40. Of three, neighbours much nearer than the other one are passed
/// over for those behind them; where there are none the curve turns at the sample itself.
template <class Smooth>
Turn turn_about(const Samples& samples, std::size_t i, Smooth&& smooth) {
  const auto &t = samples.time, &y = samples.value;
  const auto apart = [&](std::size_t a, std::size_t b) { return t[b] - t[a]; };
  if (i == 2 && samples.count >= Samples::most && smooth(0, 4) && are_alike(apart(0, 1), apart(1, 2)) &&
      are_alike(apart(1, 2), apart(2, 3)) && are_alike(apart(2, 3), apart(3, 4)))
    return turn_of_five(samples);
  const std::size_t oldest = Samples::most - std::min(samples.count, Samples::most);
  std::size_t left = i - 1, right = i + 1;
  while (left > oldest && most_uneven * apart(left, i) < apart(i, i + 1)) --left;
  while (right + 1 < Samples::most && most_uneven * apart(i, right) < apart(i - 1, i)) ++right;
  const bool extreme = (y[i] - y[left]) * (y[right] - y[i]) <= 0.0 && y[right] != y[i];
  if (!extreme || !smooth(left, right) || !are_alike(apart(left, i), apart(i, right))) return {y[i], t[i]};
  const Parabola parabola(samples, left, i, right);
  const double s = parabola.vertex();
  return {y[i] + 0.5 * parabola.slope * s, t[i] + s};
}

}  // namespace traverse::app
