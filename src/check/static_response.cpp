// Support reactions under the bridge's own weight and under the most unfavourable positions of the trains, and the
// largest static deflection at mid-span, from influence lines.
#include "static_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "norm/en1991.hpp"
#include "norm/static_bridge.hpp"
#include "results/stage.hpp"
#include "run/norm_run.hpp"

namespace traverse::check {
namespace {

constexpr double max_forces = 1000.0;
constexpr double joint_offset = 1e-9;  // m: distance of a station from a joint, on its left side
constexpr int points_per_piece = 4;    // for the integral of the bridge's own weight

/// The passing trains with their static wheel loads.
std::vector<norm::LoadModel> passing_trains(const SceneAtRest& rest) {
  std::vector<norm::LoadModel> trains;
  if (rest.whole.sweep && !rest.whole.sweep->loads.empty()) {
    for (const train::MovingLoad& load : rest.whole.sweep->loads)
      trains.push_back(norm::train_of("train", load.forces, load.positions));
  } else if (!rest.weights().empty()) {
    trains.push_back(run::static_train("train", rest.weights()));
  }
  return trains;
}

double greatest_of(const norm::InfluenceLine& line, const std::vector<norm::LoadModel>& trains) {
  double largest = 0.0;
  for (const norm::LoadModel& train : trains) largest = std::max(largest, norm::greatest(line, train).value);
  return largest;
}

/// The integral of a line over the bridge's own weight, N times its unit.
double dead_load_effect(const norm::InfluenceLine& line, const beam::BeamModel& beam, double gravity) {
  const std::vector<double>& x = line.breaks();
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double width = (x[i + 1] - x[i]) / points_per_piece;
    for (int k = 0; k < points_per_piece; ++k) {
      const double at = x[i] + (k + 0.5) * width;
      sum += width * line.value(at) * beam.mass.at(at, at) * gravity;
    }
  }
  return sum;
}

void compute_deflection(norm::StaticBridge& bridge, const std::vector<norm::LoadModel>& trains,
                        StaticResponse& response) {
  double start = bridge.model().start;
  for (const double span : bridge.model().spans) {
    const double middle = start + 0.5 * span;
    const double deflection = greatest_of(bridge.lines_at(middle)[0].times(-1.0), trains);
    if (deflection * response.span > response.deflection * span || response.span == 0.0) {
      response.deflection = deflection;
      response.at = middle;
      response.span = span;
    }
    start += span;
  }
}

/// The largest magnitude of the static displacement on one side of a surface jump under the trains.
double largest_displacement(norm::StaticBridge& bridge, double x, const std::vector<norm::LoadModel>& trains) {
  const norm::InfluenceLine line = bridge.lines_at(x)[0];
  return std::max(greatest_of(line, trains), greatest_of(line.times(-1.0), trains));
}

void compute_steps(norm::StaticBridge& bridge, const beam::BeamModel& beam, const std::vector<norm::LoadModel>& trains,
                   StaticResponse& response) {
  const beam::Mesh mesh(beam);
  for (const double x : mesh.steps()) {
    const bool left = x == mesh.start(), right = x == mesh.end();
    double height = std::max(left ? 0.0 : largest_displacement(bridge, x - joint_offset, trains),
                             right ? 0.0 : largest_displacement(bridge, x, trains));
    if (!beam.settlement.empty() && (left || right))
      height = std::max(height, std::abs(left ? beam.settlement.front() : beam.settlement.back()));
    response.steps.push_back({x, height});
  }
}

void compute_reactions(norm::StaticBridge& bridge, double gravity, const std::vector<norm::LoadModel>& trains,
                       StaticResponse& response) {
  for (const norm::StaticBridge::Bearing& bearing : bridge.bearings()) {
    const norm::InfluenceLine line = bridge.reaction(bearing);
    response.supports.push_back({bearing.x, bearing.span_end < 0, dead_load_effect(line, bridge.model(), gravity),
                                 -greatest_of(line.times(-1.0), trains), greatest_of(line, trains)});
  }
}

}  // namespace

std::vector<Axle> axles_of(const SceneAtRest& rest) {
  std::vector<Axle> axles;
  if (!rest.system) return axles;
  const train::Fleet& fleet = rest.system->fleet();
  const std::vector<coupling::StaticLoad>& weights = rest.weights();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    Axle axle;
    axle.x = weights[i].x;
    axle.force = weights[i].force;
    if (i < fleet.wheels.size()) {
      if (fleet.wheels[i].is_further) continue;
      axle.vehicle = static_cast<std::size_t>(fleet.member(static_cast<int>(i)));
      axle.type = rest.scene.train.vehicles[axle.vehicle];
      axle.name = fleet.wheel(fleet.wheels[i]).name;
    } else {
      axle.name = fmt::format("force {}", i - fleet.wheels.size());
    }
    axles.push_back(std::move(axle));
  }
  return axles;
}

StaticResponse static_response(const SceneAtRest& rest, bool with_reactions) {
  StaticResponse response;
  const beam::BeamModel& beam = *rest.scene.beam;
  if (!rest.system)
    response.why_not = "the analysis has no loads";
  else if (beam.given)
    response.why_not = "given modes contain no supports";
  else if (beam.nonlinear())
    response.why_not = "the foundation is nonlinear; the run computes its forces";
  else if (beam.spans.size() > norm::StaticBridge::most_spans)
    response.why_not = fmt::format("not computed for bridges of more than {} spans", norm::StaticBridge::most_spans);
  else if (static_cast<double>(rest.weights().size()) > max_forces)
    response.why_not = fmt::format("not computed for trains of more than {:g} wheels", max_forces);
  else if (!only_axle_loads(rest.scene.load))
    response.why_not = "computed for constant concentrated forces only";
  else if (rest.scene.train.courses.size() + rest.scene.load.courses.size() > 1)
    response.why_not = "not computed for several trains or loads, whose distances change";
  if (!response.why_not.empty()) return response;
  const results::Stage stage("influence lines");
  norm::StaticBridge bridge(beam);
  const std::vector<norm::LoadModel> trains = passing_trains(rest);
  if (with_reactions) compute_reactions(bridge, rest.scene.gravity, trains, response);
  compute_deflection(bridge, trains, response);
  if (!beam.track) compute_steps(bridge, beam, trains, response);
  return response;
}

}  // namespace traverse::check
