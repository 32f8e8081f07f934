// Lists point foundations with a nonlinear law, Gauss points of nonlinear beds, and sleepers that hang or slide, each
// with its displacement as a linear combination of the unknowns.
#include "beam/nonlinear_points.hpp"

#include <algorithm>

#include "assembly.hpp"
#include "layered_track.hpp"

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
    points.back().depth = p.depth;
    points.back().eccentricity = p.eccentricity;
    points.back().sliding = {p.k, p.law.slides_at, p.k, p.law.slides_at};
  }
}

void add_bed(std::size_t kind, const Line& bridge, int e, std::vector<NonlinearPoint>& points) {
  const std::optional<Bed>& optional_bed = bridge.model.foundation.*foundation_kinds[kind].bed;
  if (!optional_bed || !optional_bed->law.nonlinear()) return;
  const Bed& bed = *optional_bed;
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

std::vector<NonlinearPoint> hanging_sleepers(const Line& bridge, const Layout& layout, int first, int past) {
  std::vector<NonlinearPoint> points;
  if (!bridge.model.track || !bridge.model.track->hangs()) return points;
  int index = 0;
  for (const Sleeper& s : sleepers_of(bridge, 0, past)) {
    if (!s.hangs()) continue;
    NonlinearPoint point;
    point.kind = hanging_sleeper_kind;
    point.index = index++;
    point.x = s.x;
    point.at = s.at;
    point.k = s.values.ballast.k;
    point.c = s.values.ballast.c;
    point.law.one_sided = true;
    point.law.gap = s.values.gap;
    point.above = s.unknown(layout);
    point.below = s.ballast_moves ? s.ballast_unknown(layout) : -1;
    point.on_bridge = s.on_bridge && !s.ballast_moves;
    point.eccentricity = bridge.eccentricity(0);
    if (s.rail_node >= first) points.push_back(point);
  }
  return points;
}

std::vector<NonlinearPoint> sliding_sleepers(const Line& bridge, const Layout& layout, int first, int past) {
  std::vector<NonlinearPoint> points;
  if (!bridge.model.axial || !bridge.model.track || !bridge.model.track->slides()) return points;
  int index = 0;
  for (const Sleeper& s : sleepers_of(bridge, 0, past)) {
    if (!s.slides()) continue;
    NonlinearPoint point;
    point.kind = sliding_sleeper_kind;
    point.direction = Direction::longitudinal;
    point.index = index++;
    point.x = s.x;
    point.at = s.at;
    point.k = s.values.longitudinal.k;
    point.sliding = s.values.sliding();
    point.above = s.rail_node * layout.block + layout.place[rail_u];
    point.on_bridge = s.on_bridge;
    point.height = bridge.model.surface_height;
    if (s.rail_node >= first) points.push_back(point);
  }
  return points;
}

NonlinearShape shape_of(const Line& bridge, const NonlinearPoint& point) {
  NonlinearShape shape;
  double sign = 1.0;
  const auto add = [&](int unknown, double value) {
    shape.unknown[index(shape.count)] = unknown;
    shape.shape[index(shape.count++)] = value;
  };
  if (point.above >= 0) {
    add(point.above, 1.0);
    sign = -1.0;
  }
  if (point.below >= 0) add(point.below, -1.0);
  if (!point.on_bridge) return shape;
  const auto add_beam = [&](Direction direction, double factor) {
    const PointShape beam = shape_at(bridge, direction, point.at, point.depth, point.eccentricity);
    for (std::size_t i = 0; i < beam.unknown.size(); ++i)
      if (beam.unknown[i] >= 0) add(beam.unknown[i], factor * beam.shape[i]);
  };
  add_beam(point.direction, sign);
  // At a height above its axis the beam moves along x by u - height*theta.
  if (point.height != 0.0) add_beam(Direction::rotational, -sign * point.height);
  return shape;
}

}  // namespace traverse::beam
