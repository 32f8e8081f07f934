// Support reactions under the bridge's own weight and under the most unfavourable positions of the trains, and the
// largest static deflection at mid-span, from influence lines.
#include "rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "norm/load_models.hpp"
#include "norm/static_bridge.hpp"
#include "results/stage.hpp"
#include "run/norm_run.hpp"

namespace traverse::app {
namespace {

constexpr double few_forces = 1000.0;
constexpr double beside = 1e-9;       // m: of a joint, on its left side
constexpr int points_of_a_piece = 4;  // for the integral of the bridge's own weight

/// The trains that pass, each as it weighs at rest.
std::vector<norm::LoadModel> trains_of(const Look& look) {
  std::vector<norm::LoadModel> trains;
  if (look.whole.sweep && !look.whole.sweep->loads.empty()) {
    for (const MovingLoad& load : look.whole.sweep->loads)
      trains.push_back(norm::train_of("train", load.forces, load.positions));
  } else if (!look.weights().empty()) {
    trains.push_back(train_at_rest("train", look.weights()));
  }
  return trains;
}

double greatest_of(const norm::InfluenceLine& line, const std::vector<norm::LoadModel>& trains) {
  double most = 0.0;
  for (const norm::LoadModel& train : trains) most = std::max(most, norm::greatest(line, train).value);
  return most;
}

/// Of a line over the bridge's own weight, N times its unit.
double of_own_weight(const norm::InfluenceLine& line, const beam::BeamModel& beam, double gravity) {
  const std::vector<double>& x = line.breaks();
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double width = (x[i + 1] - x[i]) / points_of_a_piece;
    for (int k = 0; k < points_of_a_piece; ++k) {
      const double at = x[i] + (k + 0.5) * width;
      sum += width * line.value(at) * beam.mass.at(at, at) * gravity;
    }
  }
  return sum;
}

void find_deflection(norm::StaticBridge& bridge, const std::vector<norm::LoadModel>& trains, Rest& rest) {
  double left = bridge.model().start;
  for (const double span : bridge.model().spans) {
    const double middle = left + 0.5 * span;
    const double deflection = greatest_of(bridge.lines_at(middle)[0].times(-1.0), trains);
    if (deflection * rest.span > rest.deflection * span || rest.span == 0.0) {
      rest.deflection = deflection;
      rest.at = middle;
      rest.span = span;
    }
    left += span;
  }
}

/// How far one side of a step sinks under the trains, or rises.
double sinks_by(norm::StaticBridge& bridge, double x, const std::vector<norm::LoadModel>& trains) {
  const norm::InfluenceLine line = bridge.lines_at(x)[0];
  return std::max(greatest_of(line, trains), greatest_of(line.times(-1.0), trains));
}

void find_steps(norm::StaticBridge& bridge, const beam::BeamModel& beam, const std::vector<norm::LoadModel>& trains,
                Rest& rest) {
  const beam::Mesh mesh(beam);
  for (const double x : mesh.steps()) {
    const bool left = x == mesh.start(), right = x == mesh.end();
    double height =
        std::max(left ? 0.0 : sinks_by(bridge, x - beside, trains), right ? 0.0 : sinks_by(bridge, x, trains));
    if (!beam.settlement.empty() && (left || right))
      height = std::max(height, std::abs(left ? beam.settlement.front() : beam.settlement.back()));
    rest.steps.push_back({x, height});
  }
}

}  // namespace

std::vector<Axle> axles_of(const Look& look) {
  std::vector<Axle> axles;
  if (!look.passage) return axles;
  const train::Fleet& fleet = look.passage->system().fleet();
  const std::vector<coupling::StaticLoad>& weights = look.weights();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    Axle axle;
    axle.x = weights[i].x;
    axle.force = weights[i].force;
    if (i < fleet.wheels.size()) {
      if (fleet.wheels[i].is_further) continue;
      axle.vehicle = static_cast<std::size_t>(fleet.member(static_cast<int>(i)));
      axle.type = look.scene.train.vehicles[axle.vehicle];
      axle.name = fleet.wheel(fleet.wheels[i]).name;
    } else {
      axle.name = fmt::format("force {}", i - fleet.wheels.size());
    }
    axles.push_back(std::move(axle));
  }
  return axles;
}

Rest rest_of(const Look& look) {
  Rest rest;
  const beam::BeamModel& beam = *look.scene.beam;
  if (!look.passage)
    rest.why_not = "nothing is asked of it";
  else if (beam.given)
    rest.why_not = "given modes say nothing of supports";
  else if (beam.nonlinear())
    rest.why_not = "the foundation is not linear: it bears what the run finds";
  else if (beam.spans.size() > norm::StaticBridge::most_spans)
    rest.why_not = fmt::format("of bridges of more than {} spans they are not listed", norm::StaticBridge::most_spans);
  else if (static_cast<double>(look.weights().size()) > few_forces)
    rest.why_not = fmt::format("of trains of more than {:g} wheels they are not listed", few_forces);
  else if (look.scene.train.courses.size() + look.scene.load.courses.size() > 1)
    rest.why_not = "several trains or loads pass, at distances that change";
  if (!rest.why_not.empty()) return rest;
  const results::Stage stage("influence lines");
  norm::StaticBridge bridge(beam);
  const std::vector<norm::LoadModel> trains = trains_of(look);
  for (const norm::StaticBridge::Bearing& bearing : bridge.bearings()) {
    const norm::InfluenceLine line = bridge.reaction(bearing);
    rest.supports.push_back({bearing.x, bearing.span_end < 0, of_own_weight(line, bridge.model(), look.scene.gravity),
                             -greatest_of(line.times(-1.0), trains), greatest_of(line, trains)});
  }
  find_deflection(bridge, trains, rest);
  if (!beam.track) find_steps(bridge, beam, trains, rest);
  return rest;
}

}  // namespace traverse::app
