#include "beam/nonlinear_points.hpp"

#include <algorithm>

#include "assembly.hpp"
#include "gauss.hpp"

namespace traverse::beam {
namespace {

void add_points(std::size_t kind, const Line& bridge, int first, int past, std::vector<NonlinearPoint>& points) {
  const std::vector<PointFoundation>& list = bridge.model.foundation.*foundation_kinds[kind].points;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const PointFoundation& p = list[i];
    if (!p.law.nonlinear()) continue;
    const Station at = station_of(bridge.mesh, p);
    if (at.element < first || at.element >= past) continue;
    points.push_back({kind, foundation_kinds[kind].direction, static_cast<int>(i), p.x, at, p.k, p.c, p.law});
  }
}

void add_bed(std::size_t kind, const Line& bridge, int e, std::vector<NonlinearPoint>& points) {
  const std::optional<Bed>& there = bridge.model.foundation.*foundation_kinds[kind].bed;
  if (!there || !there->law.nonlinear()) return;
  const Bed& bed = *there;
  const Element& element = bridge.mesh.element(e);
  for (const auto& [left, right] : bed_pieces(bed, element)) {
    const double middle = 0.5 * (left + right);
    integrate(1.0, left, right, [&](double x, double length) {
      FoundationLaw law = bed.law;
      law.cubic *= length;
      const Station at{e, (x - element.x) / element.length};
      points.push_back({kind, foundation_kinds[kind].direction, element.span, x, at, length * bed.k.at(x, middle),
                        length * bed.c.at(x, middle), law});
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
  std::vector<NonlinearPoint> points;
  std::vector<std::size_t> beds;
  for (std::size_t kind = 0; kind < foundation_kind_count; ++kind) {
    if (!acts(foundation_kinds[kind], bridge.model)) continue;
    if (foundation_kinds[kind].bed != nullptr) {
      beds.push_back(kind);
    } else {
      add_points(kind, bridge, first, past, points);
    }
  }
  for (int e = first; e < past; ++e)
    for (const std::size_t kind : beds) add_bed(kind, bridge, e, points);
  return points;
}

PointShape shape_of(const Line& bridge, const NonlinearPoint& point) {
  return shape_at(bridge, point.direction, point.at);
}

}  // namespace traverse::beam
