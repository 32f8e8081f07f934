// The latest samples of a curve, and its extreme between them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/extremum.hpp"

namespace traverse::app {

using base::Extreme;

/// The last one at the end; times in s.
struct Samples {
  static constexpr std::size_t most = base::samples_kept;
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

/// Where the curve turns about the sample i, which is extreme between its neighbours; smooth(a, b): whether it has no
/// kink from sample a to b. Of three samples, neighbours much nearer than the other one are passed over for those
/// behind them; where there are none the curve turns at the sample itself.
template <class Smooth>
Extreme turn_about(const Samples& samples, std::size_t i, Smooth&& smooth) {
  const auto &t = samples.time, &y = samples.value;
  const base::Stencil by(t.data(), static_cast<int>(i),
                         static_cast<int>(Samples::most - std::min(samples.count, Samples::most)));
  const auto left = static_cast<std::size_t>(by.left), right = static_cast<std::size_t>(by.right);
  const bool five = by.five && smooth(0, 4);
  const bool turns = (y[i] - y[left]) * (y[right] - y[i]) <= 0.0 && y[right] != y[i];
  if (!five && !(by.three && turns && smooth(left, right))) return {y[i], t[i]};
  double behind = 0.0;
  const double top = base::extreme_between(t.data(), y.data(), static_cast<int>(i), by, five, behind);
  return {top, t[i] + behind};
}

}  // namespace traverse::app
