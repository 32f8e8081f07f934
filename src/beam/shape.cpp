// Hermite cubics with their derivatives; with shear the element's constant shear strain is added to the rotations at
// both ends (Friedman and Kosmatka 1993). Shapes are stored at 24 or more even intervals of each span.
#include "beam/shape.hpp"

#include <algorithm>

namespace traverse::beam {
namespace {

/// Adds gamma to the coefficients of a displacement, because the slopes at both ends are the rotations plus gamma.
void add_strain(std::array<double, 4>& form, const std::array<double, 4>& gamma) {
  const double slope_sum = form[1] + form[3];
  for (std::size_t i = 0; i < 4; ++i) form[i] += slope_sum * gamma[i];
}

constexpr int min_per_span = 24, min_total = 200;
constexpr double node_tolerance = 1e-9;  // relative to an element's length: a station this close to a node is the node

/// The number of elements of each span.
std::vector<int> elements_of_spans(const Mesh& mesh) {
  std::vector<int> count(static_cast<std::size_t>(mesh.spans()), 0);
  for (int e = 0; e < mesh.elements(); ++e) ++count[static_cast<std::size_t>(mesh.element(e).span)];
  return count;
}

}  // namespace

std::array<double, 4> shear_strain(double h, double shear) {
  const double ratio = shear / (1.0 + shear);
  return {-ratio / h, -0.5 * ratio, ratio / h, -0.5 * ratio};
}

Hermite hermite(double xi, double h, double shear) {
  const double xi2 = xi * xi, xi3 = xi2 * xi;
  const double per_h = 1.0 / h, per_h2 = per_h * per_h, per_h3 = per_h2 * per_h;
  Hermite s{};
  s.value = {1.0 - 3.0 * xi2 + 2.0 * xi3, h * (xi - 2.0 * xi2 + xi3), 3.0 * xi2 - 2.0 * xi3, h * (xi3 - xi2)};
  s.slope = {6.0 * (xi2 - xi) * per_h, 1.0 - 4.0 * xi + 3.0 * xi2, 6.0 * (xi - xi2) * per_h, 3.0 * xi2 - 2.0 * xi};
  s.curvature = {(12.0 * xi - 6.0) * per_h2, (6.0 * xi - 4.0) * per_h, (6.0 - 12.0 * xi) * per_h2,
                 (6.0 * xi - 2.0) * per_h};
  s.third = {12.0 * per_h3, 6.0 * per_h2, -12.0 * per_h3, 6.0 * per_h2};
  if (shear == 0.0) return s;
  const std::array<double, 4> gamma = shear_strain(h, shear);
  for (std::array<double, 4>* form : {&s.value, &s.slope, &s.curvature, &s.third}) add_strain(*form, gamma);
  return s;
}

std::array<double, 4> rotation(double xi, double h, double shear) {
  std::array<double, 4> form = hermite(xi, h, shear).slope;
  if (shear == 0.0) return form;
  const std::array<double, 4> gamma = shear_strain(h, shear);
  for (std::size_t i = 0; i < 4; ++i) form[i] -= gamma[i];
  return form;
}

ShapePoints::ShapePoints(const Mesh& mesh, std::vector<double> additional)
    : ShapePoints(mesh, std::move(additional), std::max(min_per_span, min_total / mesh.spans())) {}

ShapePoints::ShapePoints(const Mesh& mesh, std::vector<double> additional, int points_per_span) {
  std::sort(additional.begin(), additional.end());
  auto next = additional.begin();
  const std::vector<int> elements = elements_of_spans(mesh);
  for (int e = 0; e < mesh.elements(); ++e) {
    const Element& element = mesh.element(e);
    const int in_span = elements[static_cast<std::size_t>(element.span)];
    const int pieces = (points_per_span + in_span - 1) / in_span;
    std::vector<double> inside;  // xi
    for (int i = 1; i < pieces; ++i) inside.push_back(static_cast<double>(i) / pieces);
    for (; next != additional.end() && *next < element.x + element.length; ++next) {
      const double xi = (*next - element.x) / element.length;
      if (xi > node_tolerance && xi < 1.0 - node_tolerance) inside.push_back(xi);
    }
    std::sort(inside.begin(), inside.end());
    inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
    if (points_.empty() || points_.back().node != element.left)
      points_.push_back({mesh.x(element.left), element.left, {e, 0.0}});
    for (const double xi : inside) points_.push_back({element.x + xi * element.length, -1, {e, xi}});
    points_.push_back({mesh.x(element.left + 1), element.left + 1, {e, 1.0}});
  }
}

std::vector<double> ShapePoints::x() const {
  std::vector<double> out;
  out.reserve(points_.size());
  for (const Point& p : points_) out.push_back(p.x);
  return out;
}

}  // namespace traverse::beam
