// Cubic splines through values at increasing x, of which there are at least two.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace traverse::base {

/// Second derivatives at x. An end without a given slope has no curvature (natural spline). The tridiagonal, diagonally
/// dominant equations are eliminated downwards.
inline std::vector<double> spline_curvatures(std::span<const double> x, std::span<const double> values,
                                             const std::array<std::optional<double>, 2>& end_slopes = {}) {
  const std::size_t last = x.size() - 1;
  const auto chord = [&](std::size_t i) { return (values[i + 1] - values[i]) / (x[i + 1] - x[i]); };
  std::vector<double> curvature(last + 1, 0.0), above(last + 1, 0.0);  // above: the upper diagonal after elimination
  if (end_slopes[0]) {
    above[0] = 0.5;
    curvature[0] = 3.0 * (chord(0) - *end_slopes[0]) / (x[1] - x[0]);
  }
  for (std::size_t i = 1; i < last; ++i) {
    const double left = x[i] - x[i - 1], right = x[i + 1] - x[i], pivot = 2.0 * (left + right) - left * above[i - 1];
    above[i] = right / pivot;
    curvature[i] = (6.0 * (chord(i) - chord(i - 1)) - left * curvature[i - 1]) / pivot;
  }
  if (end_slopes[1])
    curvature[last] = (6.0 * (*end_slopes[1] - chord(last - 1)) / (x[last] - x[last - 1]) - curvature[last - 1]) /
                      (2.0 - above[last - 1]);
  for (std::size_t i = last; i-- > 0;) curvature[i] -= above[i] * curvature[i + 1];
  return curvature;
}

/// Slopes at x.
inline std::vector<double> spline_slopes(std::span<const double> x, std::span<const double> values,
                                         const std::array<std::optional<double>, 2>& end_slopes = {}) {
  std::vector<double> slope = spline_curvatures(x, values, end_slopes);
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double d = x[i + 1] - x[i], chord = (values[i + 1] - values[i]) / d, next = slope[i + 1];
    if (i + 2 == x.size()) slope[i + 1] = chord + d * (slope[i] + 2.0 * next) / 6.0;
    slope[i] = chord - d * (2.0 * slope[i] + next) / 6.0;
  }
  return slope;
}

}  // namespace traverse::base
