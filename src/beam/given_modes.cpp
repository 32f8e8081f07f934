// Slopes of mode shapes by a cubic spline, with the end slopes of a polynomial through the outermost stations, and the
// beam model of a bridge by its modes.
#include <algorithm>

#include "base/spline.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {
namespace {

constexpr std::size_t end_stations = 4;  // number of stations that determine the slope at an end
constexpr double rigid_EI = 1e40;        // N m2: prevents local deflections under forces inside an element

/// The slope at an end of the polynomial through the `count` stations nearest to it (Newton's form).
double end_slope(const std::vector<double>& x, std::vector<double> differences, std::size_t count, bool left) {
  const auto at = [&](std::size_t i) { return left ? i : x.size() - 1 - i; };
  double slope = 0.0, product = 1.0;
  for (std::size_t k = 1; k < count; ++k) {
    for (std::size_t i = count; i-- > k;)
      differences[at(i)] = (differences[at(i)] - differences[at(i - 1)]) / (x[at(i)] - x[at(i - k)]);
    slope += product * differences[at(k)];
    product *= x[at(0)] - x[at(k)];
  }
  return slope;
}

}  // namespace

std::vector<double> spline_slopes(const std::vector<double>& x, const std::vector<double>& values) {
  const std::size_t count = std::min(x.size(), end_stations);
  return base::spline_slopes(x, values, {end_slope(x, values, count, true), end_slope(x, values, count, false)});
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
