// Gauss integration of piecewise linear quantities over a part of a beam.
#pragma once

#include <array>
#include <optional>

#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// The value of `d` between a and b if it is constant there.
inline std::optional<double> constant_value(const Distribution& d, double a, double b) {
  if (d.uniform()) return d.at(a, b);
  const double value = d.at(a, b);
  if (d.at(b, a) != value) return {};
  for (double x : d.breaks(a, b)) {
    if (d.at(x, a) != value || d.at(x, b) != value) return {};
  }
  return value;
}

/// Calls sum(x, weight*d(x)) for a Gauss rule on [from, to], divided at the breaks of `d`, with four points between
/// breaks. It is exact for d(x) times a polynomial of degree 6.
template <class Sum>
void integrate(const Distribution& d, double from, double to, Sum sum) {
  constexpr std::array<double, 4> points{-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480,
                                         0.86113631159405257522};
  constexpr std::array<double, 4> weights{0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263,
                                          0.34785484513745385737};
  auto ends = d.breaks(from, to);
  ends.push_back(to);
  double left = from;
  for (double right : ends) {
    const double half = 0.5 * (right - left), middle = 0.5 * (left + right);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double x = middle + half * points[i];
      sum(x, weights[i] * half * d.at(x, middle));
    }
    left = right;
  }
}

}  // namespace traverse::beam
