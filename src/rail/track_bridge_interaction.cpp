// Load cases of UIC 774-3 (temperature, bending, braking, traction and their combinations) for every position of the
// train, with envelopes of stresses and displacements, which are printed as a table and stored in the results file.
#include "rail/track_bridge_interaction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "results/terminal.hpp"

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

void update_envelope(const std::vector<double>& values, std::vector<double>& least, std::vector<double>& greatest) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    least[i] = std::min(least[i], values[i]);
    greatest[i] = std::max(greatest[i], values[i]);
  }
}

void add(std::vector<double>& sum, const std::vector<double>& more) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}

std::string at_text(const Peak& peak, double factor, const char* unit) {
  return fmt::format("{:.4g} {} @ {:.4g}", factor * peak.value, unit,
                     1e-3 * std::round(1e3 * peak.x) + 0.0);  // avoids -0
}

std::vector<double> values_of(const std::vector<Peak>& peaks) {
  std::vector<double> values;
  for (const Peak& peak : peaks) values.push_back(peak.value);
  return values;
}

}  // namespace

RailForces::RailForces(const beam::BeamModel& model, const options::RailLoads& loads)
    : loads_(loads), bridge_(model, loads.rail_area, greatest_load(loads)), length_(model.length()) {
  for (const auto& [name, words] : names) {
    CaseResult one;
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
  thermal_ = equilibrium(strains);
  update(temperature, thermal_, 0.0);
  for (const double distance : loads_.fronts) {
    if (loads_.runs != options::Runs::to_the_left) compute_position(distance, 1.0);
    if (loads_.runs != options::Runs::to_the_right) compute_position(length_ - distance, -1.0);
  }
}

Loads RailForces::train_loads(double front, double direction) const {
  const double rear = front - direction * loads_.length;
  Loads train;
  train.from = std::min(front, rear);
  train.to = std::max(front, rear);
  train.weight = loads_.weight;
  return train;
}

// Braking pushes the rails forward, traction backward; the force acts from the front on, up to its largest value.
Loads RailForces::with_longitudinal_force(Loads train, double direction, bool brakes) const {
  const double force = brakes ? loads_.braking : loads_.traction;
  const double most = brakes ? loads_.most_braking : loads_.most_traction;
  const double length = std::min(loads_.length, most / force);
  train.along = (brakes ? direction : -direction) * force;
  train.along_from = direction > 0.0 ? train.to - length : train.from;
  train.along_to = train.along_from + length;
  return train;
}

State RailForces::equilibrium(const Loads& loads, const State* earlier) {
  State state = bridge_.equilibrium(loads, earlier);
  double force = std::abs(loads.along * (loads.along_to - loads.along_from));
  for (const double bearing : state.bearings) force = std::max(force, std::abs(bearing));
  if (force > 0.0) residual_ = std::max(residual_, std::abs(bridge_.residual(loads, state)) / force);
  return state;
}

void RailForces::update(LoadCase which, const State& state, double front) {
  CaseResult& one = cases_[which];
  one.computed = true;
  update_envelope(state.stress, one.least, one.greatest);
  update_envelope(state.displacement, one.least_slip, one.greatest_slip);
  update_stress(which, state.stress, front);
  for (std::size_t i = 0; i < state.displacement.size(); ++i)
    one.slip.update(state.displacement[i], bridge_.sleepers()[i], front);
  for (std::size_t i = 0; i < state.ends.size(); ++i) one.end.update(state.ends[i], bridge_.ends()[i], front);
  for (std::size_t i = 0; i < state.bearings.size(); ++i)
    one.bearings[i].update(state.bearings[i], bridge_.bearings()[i], front);
  for (std::size_t i = 0; i < state.openings.size(); ++i) {
    one.openings[i].update(state.openings[i], bridge_.devices()[i], front);
    one.opening.update(state.openings[i], bridge_.devices()[i], front);
  }
}

// Expansion devices release the rail's own thermal stress: a tension that only reduces the compression of warm rails is
// not counted, and vice versa.
void RailForces::update_stress(LoadCase which, const std::vector<double>& stress, double front) {
  const bool released = !bridge_.devices().empty() && which != bending && which != braking && which != traction;
  for (std::size_t i = 0; i < stress.size(); ++i) {
    const double x = bridge_.elements()[i], thermal = released ? bridge_.restrained_stress()[i] : 0.0;
    const double tension = stress[i] + std::min(thermal, 0.0), compression = stress[i] + std::max(thermal, 0.0);
    const double rounding = 1e-9 * std::abs(thermal);
    if (tension > rounding) cases_[which].tension.update(tension, x, front);
    if (compression < -rounding) cases_[which].compression.update(compression, x, front);
  }
}

/// The sum of two or three states as if nothing slid; c may be null.
void RailForces::update_sum(const State& a, const State& b, const State* c, double front) {
  State sum = a;
  for (const State* other : {&b, c}) {
    if (other == nullptr) continue;
    add(sum.stress, other->stress);
    add(sum.displacement, other->displacement);
    add(sum.bearings, other->bearings);
    add(sum.ends, other->ends);
    add(sum.openings, other->openings);
  }
  update(separate, sum, front);
}

void RailForces::compute_position(double front, double direction) {
  const Loads train = train_loads(front, direction);
  const State bending_state = equilibrium(train);
  update(bending, bending_state, front);
  bool any = false;
  for (const bool brakes : {true, false}) {
    if ((brakes ? loads_.braking : loads_.traction) == 0.0) continue;
    any = true;
    Loads all = with_longitudinal_force(train, direction, brakes);
    Loads longitudinal_only = all;
    longitudinal_only.weight = 0.0;
    const State longitudinal_state = equilibrium(longitudinal_only);
    update(brakes ? braking : traction, longitudinal_state, front);
    update_sum(thermal_, bending_state, &longitudinal_state, front);
    all.strains = true;
    update(in_sequence, equilibrium(all, &thermal_), front);
    update(at_once, equilibrium(all), front);
  }
  if (any) return;
  Loads all = train;
  all.strains = true;
  update_sum(thermal_, bending_state, nullptr, front);
  update(in_sequence, equilibrium(all, &thermal_), front);
  update(at_once, equilibrium(all), front);
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
    verdict.found = {verdict.limit.factor * std::abs(peak.value), results::EvaluatedQuantity::unknown, peak.x, "", ""};
  }
}

void RailForces::print() const {
  fmt::print(
      "UIC 774-3: additional stress of the rails, rail against deck or ground, and forces of bearings along x, "
      "each @ x in m\n");
  std::vector<std::vector<std::string>> rows = {{"", "tension", "compression", "slip", "deck end", "greatest bearing"}};
  const bool devices = !bridge_.devices().empty();
  if (devices) rows.front().emplace_back("device opening");
  for (const CaseResult& one : cases_) {
    if (!one.computed) continue;
    Peak bearing;
    for (const Peak& peak : one.bearings) bearing.update(peak.value, peak.x, peak.front);
    rows.push_back({std::string(one.words), at_text(one.tension, 1e-6, "MPa"), at_text(one.compression, 1e-6, "MPa"),
                    at_text(one.slip, 1e3, "mm"), at_text(one.end, 1e3, "mm"), at_text(bearing, 1e-3, "kN")});
    if (devices) rows.back().push_back(at_text(one.opening, 1e3, "mm"));
  }
  results::print_columns(std::move(rows));
  std::fflush(stdout);
}

void RailForces::record(results::Recorder& recorder) const {
  using Dataset = results::Recorder::Dataset;
  const std::string group = "/rail_forces/";
  std::vector<Dataset> sets = {{group + "x", {bridge_.elements().size()}, bridge_.elements(), "m"},
                               {group + "sleeper_x", {bridge_.sleepers().size()}, bridge_.sleepers(), "m"},
                               {group + "bearing_x", {bridge_.bearings().size()}, bridge_.bearings(), "m"},
                               {group + "front", {loads_.fronts.size()}, loads_.fronts, "m"}};
  const bool devices = !bridge_.devices().empty();
  if (devices) sets.push_back({group + "device_x", {bridge_.devices().size()}, bridge_.devices(), "m"});
  for (const CaseResult& one : cases_) {
    if (!one.computed) continue;
    const std::string prefix = group + std::string(one.name) + "/";
    const auto add = [&](const char* name, const std::vector<double>& values, const char* unit) {
      sets.push_back({prefix + name, {values.size()}, values, unit});
    };
    add("least_stress", one.least, "Pa");
    add("greatest_stress", one.greatest, "Pa");
    add("least_slip", one.least_slip, "m");
    add("greatest_slip", one.greatest_slip, "m");
    add("bearing", values_of(one.bearings), "N");
    if (devices) add("opening", values_of(one.openings), "m");
    const auto add_peak = [&](const char* name, const Peak& p, const char* unit) {
      sets.push_back({prefix + name, {3}, {p.value, p.x, p.front}, unit});
    };
    add_peak("tension", one.tension, "Pa, m, m");
    add_peak("compression", one.compression, "Pa, m, m");
    add_peak("slip", one.slip, "m, m, m");
    add_peak("end", one.end, "m, m, m");
  }
  recorder.datasets(sets);
  recorder.attributes("/rail_forces", {{"residual", residual_}});
}

}  // namespace traverse::rail
