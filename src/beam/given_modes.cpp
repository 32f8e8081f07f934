// Slopes of mode shapes by a cubic spline, with the end slopes of a polynomial through the outermost stations, and the
// beam model of a bridge by its modes.
#include <algorithm>
#include <cmath>

#include "traverse/beam/model.hpp"

namespace traverse::beam {
namespace {

constexpr std::size_t end_stations = 4;  // number of stations that determine the slope at an end
constexpr double rigid_EI = 1e40;        // N m2: prevents local deflections under forces inside an element

/// The slope at stations[at] of the polynomial through the first `count` stations (Lagrange).
double polynomial_slope(const double* x, const double* values, std::size_t count, std::size_t at) {
  double slope = 0.0;
  for (std::size_t j = 0; j < count; ++j) {
    double weight = 0.0;  // derivative of Lagrange's polynomial j at the station
    for (std::size_t m = 0; m < count; ++m) {
      if (m == j) continue;
      double product = 1.0 / (x[j] - x[m]);
      for (std::size_t k = 0; k < count; ++k)
        if (k != j && k != m) product *= (x[at] - x[k]) / (x[j] - x[k]);
      weight += product;
    }
    slope += weight * values[j];
  }
  return slope;
}

}  // namespace

std::vector<double> spline_slopes(const std::vector<double>& x, const std::vector<double>& values) {
  const std::size_t n = x.size(), end_count = std::min(n, end_stations);
  std::vector<double> slope(n, 0.0), diagonal(n, 1.0), above(n, 0.0);
  slope.front() = polynomial_slope(x.data(), values.data(), end_count, 0);
  slope.back() =
      polynomial_slope(x.data() + (n - end_count), values.data() + (n - end_count), end_count, end_count - 1);
  // Equal curvatures on both sides of every inner station; elimination from left to right.
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = x[i] - x[i - 1], right = x[i + 1] - x[i];
    const double rise =
        3.0 * ((values[i] - values[i - 1]) / (left * left) + (values[i + 1] - values[i]) / (right * right));
    const double factor = 1.0 / left / diagonal[i - 1];
    above[i] = 1.0 / right;
    diagonal[i] = 2.0 / left + 2.0 / right - factor * above[i - 1];
    slope[i] = rise - factor * slope[i - 1];
  }
  for (std::size_t i = n - 1; i-- > 1;) slope[i] = (slope[i] - above[i] * slope[i + 1]) / diagonal[i];
  return slope;
}

BeamModel bridge_of(GivenModes modes) {
  BeamModel model;
  model.spans = {modes.x.back()};
  model.elements = {1};
  model.EI = rigid_EI;
  model.mass = 1.0;
  model.supports = {Support::free, Support::free};
  model.axial = false;
  model.given = std::move(modes);
  return model;
}

}  // namespace traverse::beam
