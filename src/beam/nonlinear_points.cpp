#include "traverse/beam/nonlinear_points.hpp"

#include <algorithm>

#include "assembly.hpp"
#include "gauss.hpp"
#include "traverse/beam/shape.hpp"

namespace traverse::beam {
namespace {

void add_points(const std::vector<PointFoundation>& list, Direction direction, const Line& bridge, int first, int past,
                std::vector<NonlinearPoint>& points) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const PointFoundation& p = list[i];
    if (!p.law.nonlinear()) continue;
    const Station at = station_of(bridge.mesh, p);
    if (at.element < first || at.element >= past) continue;
    points.push_back({direction, false, static_cast<int>(i), p.x, at, p.k, p.c, p.law});
  }
}

void add_bed(const Bed& bed, Direction direction, const Line& bridge, int e, std::vector<NonlinearPoint>& points) {
  const Element& element = bridge.mesh.element(e);
  for (const auto& [left, right] : bed_pieces(bed, element)) {
    const double middle = 0.5 * (left + right);
    integrate(1.0, left, right, [&](double x, double length) {
      FoundationLaw law = bed.law;
      law.cubic *= length;
      const Station at{e, (x - element.x) / element.length};
      points.push_back(
          {direction, true, element.span, x, at, length * bed.k.at(x, middle), length * bed.c.at(x, middle), law});
    });
  }
}

}  // namespace

std::vector<std::pair<double, double>> bed_pieces(const Bed& bed, const Element& element) {
  const double end = element.x + element.length;
  std::vector<double> ends = bed.k.breaks(element.x, end);
  for (double x : bed.c.breaks(element.x, end)) ends.push_back(x);
  ends.push_back(end);
  std::sort(ends.begin(), ends.end());
  std::vector<std::pair<double, double>> pieces;
  double left = element.x;
  for (double right : ends) {
    if (right > left) pieces.emplace_back(left, right);
    left = right;
  }
  return pieces;
}

std::vector<NonlinearPoint> nonlinear_points(const Line& bridge, int first, int past) {
  const Foundation& f = bridge.model.foundation;
  const bool axial = bridge.model.axial;
  std::vector<NonlinearPoint> points;
  add_points(f.vertical, Direction::vertical, bridge, first, past, points);
  if (axial) add_points(f.longitudinal, Direction::longitudinal, bridge, first, past, points);
  add_points(f.rotational, Direction::rotational, bridge, first, past, points);
  for (int e = first; e < past; ++e) {
    if (f.vertical_bed && f.vertical_bed->law.nonlinear())
      add_bed(*f.vertical_bed, Direction::vertical, bridge, e, points);
    if (axial && f.longitudinal_bed && f.longitudinal_bed->law.nonlinear())
      add_bed(*f.longitudinal_bed, Direction::longitudinal, bridge, e, points);
  }
  return points;
}

PointShape shape_of(const Line& bridge, const NonlinearPoint& point) {
  PointShape s;
  if (point.direction == Direction::longitudinal) {
    const auto unknowns = bridge.axial(point.at.element);
    const auto phi = linear(point.at.xi);
    std::copy(unknowns.begin(), unknowns.end(), s.unknown.begin());
    std::copy(phi.begin(), phi.end(), s.shape.begin());
    return s;
  }
  const Hermite psi = hermite(point.at.xi, bridge.mesh.element(point.at.element).length);
  s.unknown = bridge.transverse(point.at.element);
  s.shape = point.direction == Direction::vertical ? psi.value : psi.slope;
  return s;
}

}  // namespace traverse::beam
