// Distributes sections along every span and evaluates the least and the greatest effect of every load from each
// influence line and its negative.
#include "norm/static_effects.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace traverse::norm {
namespace {

constexpr double parts_of_span = 20.0,
                 support_offset = 1e-6;  // relative to the span: distance of sections from a support
constexpr std::size_t max_springs = 200;

Place place_of(const beam::BeamModel& model, double x) {
  Place place{x, 0.0, 0};
  double start = 0.0;
  for (std::size_t i = 0; i < model.spans.size(); start += model.spans[i++]) {
    const double slack = support_offset * model.spans[i];
    if (x < start - slack || x > start + model.spans[i] + slack) continue;
    if (place.span == 0.0 || model.spans[i] < place.span) place = {x, model.spans[i], i};
  }
  return place;
}

std::vector<Place> sections_of(const beam::BeamModel& model, double spacing,
                               const std::vector<double>& given_stations) {
  std::vector<double> x = given_stations;
  const auto add = [&](double station, double slack) {  // unless it is one of the given stations, but for rounding
    if (std::none_of(given_stations.begin(), given_stations.end(),
                     [&](double given) { return std::abs(given - station) < slack; }))
      x.push_back(station);
  };
  double start = 0.0;
  for (const double span : model.spans) {
    const double parts = spacing > 0.0 ? std::max(1.0, std::ceil(span / spacing - support_offset)) : parts_of_span;
    for (double i = 0.0; i <= parts; ++i)
      add(start + span * std::clamp(i / parts, support_offset, 1.0 - support_offset), 0.1 * support_offset * span);
    start += span;
  }
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end()), x.end());
  std::vector<Place> places;
  for (const double one : x) places.push_back(place_of(model, one));
  return places;
}

}  // namespace

StaticEffects static_effects(StaticBridge& bridge, std::vector<LoadModel> loads, double spacing,
                             const std::vector<double>& given_stations) {
  StaticEffects result;
  result.loads = std::move(loads);
  const beam::BeamModel& model = bridge.model();
  std::vector<StaticBridge::Bearing> bearings = bridge.bearings();
  const auto is_spring = [](const StaticBridge::Bearing& b) { return b.span_end < 0; };
  if (bearings.size() > max_springs) std::erase_if(bearings, is_spring);
  const auto places = [&](Effect effect) -> std::vector<Place>& {
    return result.places[static_cast<std::size_t>(effect)];
  };
  for (const Effect effect : {Effect::deflection, Effect::moment, Effect::shear})
    places(effect) = sections_of(model, spacing, given_stations);
  for (const StaticBridge::Bearing& b : bearings) places(Effect::reaction).push_back(place_of(model, b.x));
  places(Effect::end_rotation) = {place_of(model, 0.0), place_of(model, model.length())};
  const std::vector<int> joints = bridge.joints();
  for (const int i : joints)
    places(Effect::joint_rotation)
        .push_back(place_of(model, std::accumulate(model.spans.begin(), model.spans.begin() + i, 0.0)));
  for (std::size_t e = 0; e < effect_count; ++e) result.values[e].resize(result.loads.size() * result.places[e].size());

  const auto store = [&](Effect effect, std::size_t place, const InfluenceLine& line) {
    const auto e = static_cast<std::size_t>(effect);
    const InfluenceLine mirrored = line.times(-1.0);
    for (std::size_t load = 0; load < result.loads.size(); ++load) {
      Extremes& extremes = result.values[e][load * result.places[e].size() + place];
      extremes = {greatest(mirrored, result.loads[load]), greatest(line, result.loads[load])};
      extremes.least.value = -extremes.least.value;
    }
  };
  for (std::size_t i = 0; i < places(Effect::deflection).size(); ++i) {
    const auto lines = bridge.lines_at(places(Effect::deflection)[i].x);
    store(Effect::deflection, i, lines[0]);
    store(Effect::moment, i, lines[1]);
    store(Effect::shear, i, lines[2]);
  }
  for (std::size_t i = 0; i < bearings.size(); ++i) store(Effect::reaction, i, bridge.reaction(bearings[i]));
  store(Effect::end_rotation, 0, bridge.end_rotation(false));
  store(Effect::end_rotation, 1, bridge.end_rotation(true));
  for (std::size_t i = 0; i < joints.size(); ++i) store(Effect::joint_rotation, i, bridge.joint_rotation(joints[i]));
  return result;
}

}  // namespace traverse::norm
