// The latest samples of a curve, and its extreme between them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/extremum.hpp"

namespace traverse::run {

using base::Extreme;

/// The latest samples in ascending order of time; times in s.
struct Samples {
  static constexpr std::size_t max_count = base::samples_kept;
  std::array<double, max_count> time{}, value{};
  std::size_t count = 0;  // number of samples added so far

  void push(double t, double y) {
    std::rotate(time.begin(), time.begin() + 1, time.end());
    std::rotate(value.begin(), value.begin() + 1, value.end());
    time.back() = t;
    value.back() = y;
    ++count;
  }
};

/// The extreme of the curve near sample i, which is extreme between its neighbours. smooth(a, b): whether the curve has
/// no kink from sample a to sample b. With three samples, a neighbour much closer than the other neighbour is replaced
/// by the next sample behind it; if that does not exist, the extreme is the sample itself.
template <class Smooth>
Extreme interpolate_extremum(const Samples& samples, std::size_t i, Smooth&& smooth) {
  const auto &t = samples.time, &y = samples.value;
  const base::Stencil by(t.data(), static_cast<int>(i),
                         static_cast<int>(Samples::max_count - std::min(samples.count, Samples::max_count)));
  const auto left = static_cast<std::size_t>(by.left), right = static_cast<std::size_t>(by.right);
  const bool five = by.five && smooth(0, 4);
  const bool is_extreme = (y[i] - y[left]) * (y[right] - y[i]) <= 0.0 && y[right] != y[i];
  if (!five && !(by.three && is_extreme && smooth(left, right))) return {y[i], t[i]};
  double offset = 0.0;
  const double extreme = base::extreme_between(t.data(), y.data(), static_cast<int>(i), by, five, offset);
  return {extreme, t[i] + offset};
}

}  // namespace traverse::run
