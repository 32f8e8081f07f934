// Places sections along every span and evaluates the least and the greatest effect of every load from each influence
// line and its negative.
#include "norm/static_effects.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace traverse::norm {
namespace {

constexpr double parts_of_span = 20.0, beside = 1e-6;  // the latter of the span
constexpr std::size_t most_springs = 200;

Place place_of(const beam::BeamModel& model, double x) {
  Place place{x, 0.0, 0};
  double left = 0.0;
  for (std::size_t i = 0; i < model.spans.size(); left += model.spans[i++]) {
    const double slack = beside * model.spans[i];
    if (x < left - slack || x > left + model.spans[i] + slack) continue;
    if (place.span == 0.0 || model.spans[i] < place.span) place = {x, model.spans[i], i};
  }
  return place;
}

std::vector<Place> sections_of(const beam::BeamModel& model, double spacing, const std::vector<double>& also) {
  std::vector<double> x = also;
  double left = 0.0;
  for (const double span : model.spans) {
    const double parts = spacing > 0.0 ? std::max(1.0, std::ceil(span / spacing - beside)) : parts_of_span;
    for (double i = 0.0; i <= parts; ++i) x.push_back(left + span * std::clamp(i / parts, beside, 1.0 - beside));
    left += span;
  }
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end()), x.end());
  std::vector<Place> places;
  for (const double one : x) places.push_back(place_of(model, one));
  return places;
}

}  // namespace

StaticEffects static_effects(StaticBridge& bridge, std::vector<LoadModel> loads, double spacing,
                             const std::vector<double>& also) {
  StaticEffects result;
  result.loads = std::move(loads);
  const beam::BeamModel& model = bridge.model();
  std::vector<StaticBridge::Bearing> bearings = bridge.bearings();
  const auto is_spring = [](const StaticBridge::Bearing& b) { return b.span_end < 0; };
  if (bearings.size() > most_springs) std::erase_if(bearings, is_spring);
  const auto places = [&](Effect effect) -> std::vector<Place>& {
    return result.places[static_cast<std::size_t>(effect)];
  };
  for (const Effect effect : {Effect::deflection, Effect::moment, Effect::shear})
    places(effect) = sections_of(model, spacing, also);
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
      Extremes& found = result.values[e][load * result.places[e].size() + place];
      found = {greatest(mirrored, result.loads[load]), greatest(line, result.loads[load])};
      found.least.value = -found.least.value;
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
