// Computes deflections at the nodes from the stored displacement vector, and those inside elements by recovery with the
// loads of that instant.
#include "run/deflected_shape.hpp"

#include <algorithm>

#include "beam/shape.hpp"
#include "beam/support_line.hpp"

namespace traverse::run {
namespace {

constexpr std::size_t points_per_call = 4000;  // points inside elements in one call; each needs a kilobyte

using Point = beam::ShapePoints::Point;

/// Collective. Adds the deflections of the nodes of all ranks.
void add_nodes(const beam::Beam& beam, const std::vector<double>& v, const std::vector<Point>& points,
               std::vector<double>& deflection) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int local = points[i].node < 0 ? -1 : beam.local(beam.bridge().unknown(points[i].node, 1));
    if (local >= 0) deflection[i] = v[static_cast<std::size_t>(local)];
  }
  MPI_Allreduce(MPI_IN_PLACE, deflection.data(), static_cast<int>(deflection.size()), MPI_DOUBLE, MPI_SUM, beam.comm());
}

/// Collective. Sets the deflections of points[which[0]], points[which[1]], ...
void fill_inside(const beam::Beam& beam, double self_weight, const LargestDeflection& worst,
                 const std::vector<Point>& points, const std::vector<std::size_t>& which,
                 std::vector<double>& deflection) {
  std::vector<double> stations;
  for (const std::size_t i : which) stations.push_back(points[i].x);
  recovery::Recovery recovery(beam, std::move(stations), self_weight);
  std::vector<recovery::Response> responses;
  recovery.evaluate(worst.v.data(), worst.w.data(), worst.a.data(), worst.loads, responses);
  for (std::size_t k = 0; k < which.size(); ++k) deflection[which[k]] = responses[k].deflection;
}

}  // namespace

results::Shape shape_of(const beam::Beam& beam, const scene::Scene& scene, const LargestDeflection& worst) {
  const beam::ShapePoints shape(beam.mesh(), scene.output.probes);
  const std::vector<Point>& points = shape.points();
  results::Shape out{worst.time, shape.x(), std::vector<double>(points.size(), 0.0)};
  add_nodes(beam, worst.v, points, out.deflection);
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].node < 0) which.push_back(i);
    if (which.size() < points_per_call && (i + 1 < points.size() || which.empty())) continue;
    fill_inside(beam, scene.self_weight ? scene.gravity : 0.0, worst, points, which, out.deflection);
    which.clear();
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const beam::SupportLine line = beam::support_line(beam.model(), points[i].x);
    out.deflection[i] -= line.height(beam.model().settlement) + line.height(worst.ground);
  }
  return out;
}

}  // namespace traverse::run
