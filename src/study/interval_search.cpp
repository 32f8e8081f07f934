// Brackets each value at which a sampled ratio passes 1, and shrinks the brackets by the zeros of local interpolations.
// Bounds the peak between two neighbouring speeds by the curvature of the parabola through three samples, or near a
// limit by the width of a resonance curve, and halves intervals that are too uncertain.
#include "study/interval_search.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace traverse::study {
namespace {

constexpr double part_of_accuracy =
    0.4;  // distance of an added value from the estimated zero, relative to the accuracy
constexpr double part_of_interval = 0.05;  // the same, relative to the interval: the larger one is used
constexpr int bisections = 40;             // of the interpolation, to the last digits

bool within(double ratio) { return ratio <= 1.0; }

/// The polynomial through the samples first to last at x, by Lagrange.
double interpolate(const std::vector<double>& value, const std::vector<double>& ratio, std::size_t first,
                   std::size_t last, double x) {
  double sum = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    double term = ratio[i];
    for (std::size_t j = first; j <= last; ++j)
      if (j != i) term *= (x - value[j]) / (value[i] - value[j]);
    sum += term;
  }
  return sum;
}

/// The value between samples i and i + 1, on different sides of 1, at which the cubic through four samples passes 1.
double estimated_zero(const std::vector<double>& value, const std::vector<double>& ratio, std::size_t i) {
  std::size_t first = i > 0 ? i - 1 : i, last = std::min(i + 2, value.size() - 1);
  for (std::size_t k = first; k <= last; ++k)
    if (!std::isfinite(ratio[k])) first = i, last = i + 1;
  double low = value[i], high = value[i + 1];
  const bool rises = within(ratio[i]);
  for (int k = 0; k < bisections; ++k) {
    const double middle = 0.5 * (low + high);
    (within(interpolate(value, ratio, first, last, middle)) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void shrink(const std::vector<double>& value, const std::vector<double>& ratio, std::size_t i, double accuracy,
            std::set<double>& added) {
  const double low = value[i], high = value[i + 1], length = high - low;
  if (!std::isfinite(ratio[i]) || !std::isfinite(ratio[i + 1])) {
    added.insert(0.5 * (low + high));
    return;
  }
  const double zero = estimated_zero(value, ratio, i);
  const double distance = std::max(part_of_accuracy * accuracy * std::abs(zero), part_of_interval * length);
  for (const double x : {zero - distance, zero + distance})
    if (x > low && x < high) added.insert(x);
  if (zero < low + 0.25 * length || zero > high - 0.25 * length) added.insert(0.5 * (low + high));
}

/// The ratio reflected at 1: a minimum above the bound is a peak that may reach it.
std::vector<double> reflected(const std::vector<double>& ratio) {
  std::vector<double> other(ratio.size());
  std::transform(ratio.begin(), ratio.end(), other.begin(), [](double r) { return 2.0 - r; });
  return other;
}

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

std::vector<WithinInterval> intervals_within(const std::vector<double>& value, const std::vector<double>& ratio) {
  std::vector<WithinInterval> intervals;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!within(ratio[i])) continue;
    if (i == 0 || !within(ratio[i - 1])) intervals.push_back({value[i], value[i], i == 0, false});
    intervals.back().to = value[i];
    intervals.back().to_is_end = i + 1 == value.size();
  }
  return intervals;
}

std::vector<double> values_to_add(const std::vector<double>& value, const std::vector<std::vector<double>>& ratios,
                                  double accuracy) {
  std::set<double> added;
  for (const std::vector<double>& ratio : ratios) {
    const std::vector<double> below = reflected(ratio);
    for (std::size_t i = 0; i + 1 < value.size(); ++i) {
      const double length = value[i + 1] - value[i];
      if (length <= accuracy * std::max(std::abs(value[i]), std::abs(value[i + 1]))) continue;
      if (within(ratio[i]) != within(ratio[i + 1]))
        shrink(value, ratio, i, accuracy, added);
      else if (possible_peak(value, within(ratio[i]) ? ratio : below, i) > 1.0)
        added.insert(value[i] + 0.5 * length);
    }
  }
  std::vector<double> apart;  // values of several curves can nearly coincide
  for (const double x : added)
    if (apart.empty() || x - apart.back() > 0.5 * part_of_accuracy * accuracy * std::abs(x)) apart.push_back(x);
  return apart;
}

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
