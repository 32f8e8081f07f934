// Load cases of UIC 774-3 (temperature, bending, braking, traction and their combinations) for every position of the
// train, with envelopes of stresses and displacements.
#include "rail/track_bridge_interaction.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::rail {
namespace {

constexpr std::pair<std::string_view, std::string_view> names[case_count] = {
    {"temperature", "temperature"}, {"bending", "the train's weight"}, {"braking", "braking"},
    {"traction", "traction"},       {"separate", "these added up"},    {"in_sequence", "one after the other"},
    {"at_once", "all at once"},
};

double greatest_load(const options::RailLoads& loads) {
  return loads.length * std::max({loads.weight, loads.braking, loads.traction, 1.0});
}

void observe_envelope(const std::vector<double>& values, std::vector<double>& least, std::vector<double>& greatest) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    least[i] = std::min(least[i], values[i]);
    greatest[i] = std::max(greatest[i], values[i]);
  }
}

void add(std::vector<double>& sum, const std::vector<double>& more) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}

}  // namespace

RailForces::RailForces(const beam::BeamModel& model, const options::RailLoads& loads)
    : loads_(loads), bridge_(model, loads.rail_area, greatest_load(loads)), length_(model.length()) {
  for (const auto& [name, words] : names) {
    Case one;
    one.name = name;
    one.words = words;
    one.least.assign(bridge_.elements().size(), HUGE_VAL);
    one.greatest.assign(bridge_.elements().size(), -HUGE_VAL);
    one.least_slip.assign(bridge_.sleepers().size(), HUGE_VAL);
    one.greatest_slip.assign(bridge_.sleepers().size(), -HUGE_VAL);
    one.bearings.resize(bridge_.bearings().size());
    one.openings.resize(bridge_.devices().size());
    cases_.push_back(std::move(one));
  }
  Loads strains;
  strains.strains = true;
  warm_ = rest(strains);
  see(temperature, warm_, 0.0);
  for (const double beyond : loads_.fronts) {
    if (loads_.runs != options::Runs::to_the_left) stand(beyond, 1.0);
    if (loads_.runs != options::Runs::to_the_right) stand(length_ - beyond, -1.0);
  }
}

Loads RailForces::standing(double front, double direction) const {
  const double rear = front - direction * loads_.length;
  Loads train;
  train.from = std::min(front, rear);
  train.to = std::max(front, rear);
  train.weight = loads_.weight;
  return train;
}

// Braking pushes the rails ahead, traction pushes them back; from the front on, until there is the greatest force.
Loads RailForces::acting(Loads train, double direction, bool brakes) const {
  const double force = brakes ? loads_.braking : loads_.traction;
  const double most = brakes ? loads_.most_braking : loads_.most_traction;
  const double length = std::min(loads_.length, most / force);
  train.along = (brakes ? direction : -direction) * force;
  train.along_from = direction > 0.0 ? train.to - length : train.from;
  train.along_to = train.along_from + length;
  return train;
}

State RailForces::rest(const Loads& loads, const State* before) {
  State state = bridge_.rest(loads, before);
  double force = std::abs(loads.along * (loads.along_to - loads.along_from));
  for (const double bearing : state.bearings) force = std::max(force, std::abs(bearing));
  if (force > 0.0) residual_ = std::max(residual_, std::abs(bridge_.residual(loads, state)) / force);
  return state;
}

void RailForces::see(Which which, const State& state, double front) {
  Case& one = cases_[which];
  one.there = true;
  observe_envelope(state.stress, one.least, one.greatest);
  observe_envelope(state.displacement, one.least_slip, one.greatest_slip);
  observe_stress(which, state.stress, front);
  for (std::size_t i = 0; i < state.displacement.size(); ++i)
    one.slip.see(state.displacement[i], bridge_.sleepers()[i], front);
  for (std::size_t i = 0; i < state.ends.size(); ++i) one.end.see(state.ends[i], bridge_.ends()[i], front);
  for (std::size_t i = 0; i < state.bearings.size(); ++i)
    one.bearings[i].see(state.bearings[i], bridge_.bearings()[i], front);
  for (std::size_t i = 0; i < state.openings.size(); ++i) {
    one.openings[i].see(state.openings[i], bridge_.devices()[i], front);
    one.opening.see(state.openings[i], bridge_.devices()[i], front);
  }
}

// Expansion devices release what the rail's own temperature does to it: no tension is counted that only takes away
// compression of warm rails, and the reverse.
void RailForces::observe_stress(Which which, const std::vector<double>& stress, double front) {
  const bool released = !bridge_.devices().empty() && which != bending && which != braking && which != traction;
  for (std::size_t i = 0; i < stress.size(); ++i) {
    const double x = bridge_.elements()[i], own = released ? bridge_.own_stress()[i] : 0.0;
    const double tension = stress[i] + std::min(own, 0.0), compression = stress[i] + std::max(own, 0.0);
    const double rounding = 1e-9 * std::abs(own);
    if (tension > rounding) cases_[which].tension.see(tension, x, front);
    if (compression < -rounding) cases_[which].compression.see(compression, x, front);
  }
}

/// What three states would be together if nothing slid; c: null: two.
void RailForces::observe_sum(const State& a, const State& b, const State* c, double front) {
  State sum = a;
  for (const State* other : {&b, c}) {
    if (other == nullptr) continue;
    add(sum.stress, other->stress);
    add(sum.displacement, other->displacement);
    add(sum.bearings, other->bearings);
    add(sum.ends, other->ends);
    add(sum.openings, other->openings);
  }
  see(separate, sum, front);
}

void RailForces::stand(double front, double direction) {
  const Loads train = standing(front, direction);
  const State bent = rest(train);
  see(bending, bent, front);
  bool any = false;
  for (const bool brakes : {true, false}) {
    if ((brakes ? loads_.braking : loads_.traction) == 0.0) continue;
    any = true;
    Loads all = acting(train, direction, brakes);
    Loads alone = all;
    alone.weight = 0.0;
    const State pushed = rest(alone);
    see(brakes ? braking : traction, pushed, front);
    observe_sum(warm_, bent, &pushed, front);
    all.strains = true;
    see(in_sequence, rest(all, &warm_), front);
    see(at_once, rest(all), front);
  }
  if (any) return;
  Loads all = train;
  all.strains = true;
  observe_sum(warm_, bent, nullptr, front);
  see(in_sequence, rest(all, &warm_), front);
  see(at_once, rest(all), front);
}

void RailForces::find(std::vector<results::Verdict>& verdicts) const {
  const auto larger = [](const Peak& a, const Peak& b) { return std::abs(a.value) >= std::abs(b.value) ? a : b; };
  for (results::Verdict& verdict : verdicts) {
    const std::string& quantity = verdict.limit.quantity;
    if (quantity == "rail_device_opening" && bridge_.devices().empty()) {
      verdict.found.why = "the rail has no expansion devices (track_rail_expansion_devices)";
      continue;
    }
    const Peak peak = quantity == "rail_tension"          ? cases_[in_sequence].tension
                      : quantity == "rail_compression"    ? cases_[in_sequence].compression
                      : quantity == "rail_slip"           ? larger(cases_[braking].slip, cases_[traction].slip)
                      : quantity == "deck_displacement"   ? larger(cases_[braking].end, cases_[traction].end)
                      : quantity == "rail_device_opening" ? cases_[in_sequence].opening
                                                          : cases_[bending].end;
    verdict.found = {std::abs(peak.value), results::EvaluatedQuantity::unknown, peak.x, "", ""};
  }
}

}  // namespace traverse::rail
