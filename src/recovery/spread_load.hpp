// A load that is spread over a part of an element as point loads of a Gauss rule.
#pragma once

#include <algorithm>
#include <array>

#include "recovery/recovery.hpp"

namespace traverse::recovery {

/// Calls f(ElementLoad) with point loads that have the effect of `load`, exact for responses that are polynomials of xi
/// up to degree 5 on both sides of `kink`. A concentrated load is its own point.
template <class F>
void for_points(const ElementLoad& load, double kink, F f) {
  if (load.extent == 0.0) return f(load);
  constexpr std::array<double, 3> place = {-0.7745966692414834, 0.0, 0.7745966692414834};
  constexpr std::array<double, 3> weight = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const double left = load.xi - 0.5 * load.extent, right = load.xi + 0.5 * load.extent;
  const double middle = std::clamp(kink, left, right);
  for (const auto& [from, to] : {std::array{left, middle}, std::array{middle, right}}) {
    if (!(to > from)) continue;
    for (std::size_t i = 0; i < place.size(); ++i) {
      const double part = weight[i] * (to - from) / load.extent;
      ElementLoad point = load;
      point.xi = 0.5 * (from + to) + 0.5 * (to - from) * place[i];
      point.fx *= part;
      point.fy *= part;
      point.moment *= part;
      point.extent = 0.0;
      f(point);
    }
  }
}

}  // namespace traverse::recovery
