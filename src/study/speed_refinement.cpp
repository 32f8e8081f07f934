// Bounds the peak between two neighbouring speeds by the curvature of the parabola through three samples, or near a
// limit by the width of a resonance curve, and halves intervals that are too uncertain.
#include "study/speed_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace traverse::study {
namespace {

constexpr double shortest_interval = 1e-7;  // relative to the speed
constexpr double curvature_factor = 4.0;    // ratio of a peak's possible curvature to the computed curvature
constexpr double accepted_error = 1e-2;     // largest relative error of a peak that is accepted

/// The curvature -y'' of the parabola through a sample and its neighbours; 0 if it is negative, and at both ends.
double curvature_at(const std::vector<double>& v, const std::vector<double>& y, std::size_t i) {
  if (i == 0 || i + 1 >= v.size()) return 0.0;
  const double before = (y[i] - y[i - 1]) / (v[i] - v[i - 1]), after = (y[i + 1] - y[i]) / (v[i + 1] - v[i]);
  return std::max(0.0, 2.0 * (before - after) / (v[i + 1] - v[i - 1]));
}

}  // namespace

double possible_peak(const std::vector<double>& v, const std::vector<double>& y, std::size_t i) {
  const double h = v[i + 1] - v[i], curvature = std::max(curvature_at(v, y, i), curvature_at(v, y, i + 1));
  return std::max(y[i], y[i + 1]) + 0.125 * curvature_factor * curvature * h * h;
}

Refinement refine(const std::vector<double>& speed, const std::vector<SpeedCurve>& curves, double tolerance) {
  Refinement refinement;
  std::set<double> added;
  for (const SpeedCurve& curve : curves) {
    std::vector<double> v, y;
    for (std::size_t i = 0; i < speed.size(); ++i)
      if (!std::isnan(curve.value[i])) {
        v.push_back(speed[i]);
        y.push_back(curve.value[i]);
      }
    const double largest = y.empty() ? 0.0 : *std::max_element(y.begin(), y.end());
    if (!(largest > 0.0)) continue;
    for (std::size_t i = 0; i + 1 < v.size(); ++i) {
      const double h = v[i + 1] - v[i], above = possible_peak(v, y, i) / largest - 1.0;
      if (above > refinement.uncertainty) {
        refinement.uncertainty = above;
        refinement.curve = curve.name;
      }
      if (above > tolerance && h > shortest_interval * v[i]) added.insert(v[i] + 0.5 * h);
    }
  }
  refinement.speeds.assign(added.begin(), added.end());
  return refinement;
}

Refinement refine_for_limits(const std::vector<double>& speed, const std::vector<LimitedCurve>& curves, double width) {
  Refinement refinement;
  std::set<double> added;
  for (const auto& [curve, limit] : curves)
    for (std::size_t i = 0; i + 1 < speed.size(); ++i) {
      const double h = speed[i + 1] - speed[i], middle = speed[i] + 0.5 * h;
      const double above = std::hypot(1.0, h / (width * middle)) - 1.0;
      const double highest = std::fmax(curve.value[i], curve.value[i + 1]);  // ignores NaN
      if (above <= accepted_error || !((1.0 + above) * highest > limit)) continue;
      added.insert(middle);
      if (above <= refinement.uncertainty) continue;
      refinement.uncertainty = above;
      refinement.curve = curve.name;
    }
  refinement.speeds.assign(added.begin(), added.end());
  return refinement;
}

}  // namespace traverse::study
