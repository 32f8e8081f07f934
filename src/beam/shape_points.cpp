// Divides the elements evenly, into at least 24 intervals per span and about 200 on a bridge of few spans, and inserts
// the requested stations.
#include "beam/shape_points.hpp"

#include <algorithm>

namespace traverse::beam {
namespace {

constexpr int min_per_span = 24, min_total = 200;
constexpr double node_tolerance = 1e-9;  // relative to an element's length: a station this close to a node is the node

/// The number of elements of each span.
std::vector<int> elements_of_spans(const Mesh& mesh) {
  std::vector<int> count(static_cast<std::size_t>(mesh.spans()), 0);
  for (int e = 0; e < mesh.elements(); ++e) ++count[static_cast<std::size_t>(mesh.element(e).span)];
  return count;
}

}  // namespace

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
