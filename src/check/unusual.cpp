// Compares input with usual ranges, among them the bounds of the first natural frequency of railway bridges in figure
// 6.10 of EN 1991-2, and suggests which unit may have been confused.
#include "unusual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "norm/en1991.hpp"

namespace traverse::app {
namespace {

using Lines = std::vector<std::string>;

constexpr double fast = 150.0, noted_as_fast = 160.0;          // m/s; beyond the latter the scene's reader says so
constexpr double heaviest_axle = 40e3, lightest_axle = 100.0;  // kg
constexpr double bridge_from = 4.0;                            // m: shorter spans carry anything
constexpr double lightest_bridge = 50.0;                       // kg/m, of such a span
constexpr double other_unit = 31.6227766;  // times a frequency, where EI or the mass is a thousand times another
constexpr double near_bounds = 2.0;        // times and parts of the bounds
constexpr double much_damping = 0.1;
constexpr double much_deflection = 1.0 / 300.0;    // of the span
constexpr double noted_step = 1e-4;                // m: of the running surface
constexpr double earth = 9.81, near_earth = 0.05;  // m/s2
constexpr double nearly_all = 0.99;                // of the time until the train has left
constexpr double one_share = 1e-3;                 // of the mean: a wheel that carries less carries nothing

/// Whether it spans from support to support, as figure 6.10 of EN 1991-2 has it.
bool is_bridge(const beam::BeamModel& beam) {
  const bool held = std::all_of(beam.supports.begin(), beam.supports.end(), beam::fixes_vertical);
  return held && beam.foundation.vertical.empty() && !beam.foundation.vertical_bed && beam.hinges.empty() &&
         beam.cracks.empty();
}

bool between(double value, const std::pair<double, double>& bounds, double slack) {
  return value >= bounds.first / slack && value <= bounds.second * slack;
}

void look_at_frequency(const Look& look, Lines& lines) {
  const beam::BeamModel& beam = *look.scene.beam;
  if (look.frequencies.empty() || !is_bridge(beam)) return;
  const std::vector<double> lengths = norm::determinant_lengths(beam);
  const double length = *std::max_element(lengths.begin(), lengths.end()), n0 = look.frequencies.front();
  const auto bounds = norm::frequency_bounds(length);
  if (!bounds || between(n0, *bounds, 1.0)) return;
  std::string line = fmt::format(
      "the first frequency, {:.3g} Hz, is {} what railway bridges of {:.3g} m have: {:.3g} to {:.3g} Hz "
      "(EN 1991-2, figure 6.10)",
      n0, n0 < bounds->first ? "below" : "above", length, bounds->first, bounds->second);
  if (!between(n0, *bounds, near_bounds) && between(n0 * other_unit, *bounds, near_bounds))
    line += "; beam_EI looks as if it were given in kN m2, it is in N m2";
  else if (!between(n0, *bounds, near_bounds) && between(n0 / other_unit, *bounds, near_bounds))
    line += "; beam_mass looks as if it were given in t/m, it is in kg/m";
  lines.push_back(line);
}

void look_at_weight(const Look& look, Lines& lines) {
  const beam::BeamModel& beam = *look.scene.beam;
  const double span = *std::min_element(beam.spans.begin(), beam.spans.end());
  if (is_bridge(beam) && span >= bridge_from && beam.mass.maximum() < lightest_bridge)
    lines.push_back(fmt::format("beam_mass: {:g} kg/m are little for spans of {:g} m; as if it were given in t/m",
                                beam.mass.maximum(), span));
}

void look_at_damping(const Look& look, Lines& lines) {
  const Damping& damping = look.scene.damping;
  double ratio = damping.ratios ? std::max(damping.ratios->first, damping.ratios->second) : 0.0;
  for (const double one : look.scene.damping_of_modes) ratio = std::max(ratio, one);
  if (look.scene.by_given_modes())
    for (const double one : look.scene.beam->given->ratio) ratio = std::max(ratio, one);
  if (ratio > much_damping)
    lines.push_back(fmt::format("a damping ratio of {:g} is {:g} % of critical damping, bridges have 0.5 to 3 %", ratio,
                                100.0 * ratio));
}

void look_at_deflection(const Rest& rest, Lines& lines) {
  if (rest.span > 0.0 && rest.deflection > much_deflection * rest.span)
    lines.push_back(
        fmt::format("at rest the bridge deflects by {:.3g} m at x = {:g} m, 1/{:.0f} of its span: as if "
                    "beam_EI or the loads were in other units",
                    rest.deflection, rest.at, rest.span / rest.deflection));
}

void look_at_steps(const Look& look, const Rest& rest, Lines& lines) {
  if (look.passage == nullptr || look.passage->system().fleet().wheels.empty()) return;
  for (const SurfaceStep& step : rest.steps)
    if (step.height > noted_step)
      lines.push_back(
          fmt::format("the running surface steps by up to {:.3g} mm at x = {:g} m, where nothing rigid holds "
                      "both sides at one height: wheels strike its edge",
                      1e3 * step.height, step.x));
}

void look_at_axles(const Look& look, const std::vector<Axle>& axles, Lines& lines) {
  if (axles.empty() || !(look.scene.gravity > 0.0)) return;
  const auto by_force = [](const Axle& a, const Axle& b) { return a.force < b.force; };
  const auto [least, most] = std::minmax_element(axles.begin(), axles.end(), by_force);
  if (most->force > heaviest_axle * earth)
    lines.push_back(fmt::format("{}: {:.4g} kN, {:.3g} t, on one axle; the heaviest on rails carry 40 t", most->name,
                                1e-3 * most->force, 1e-3 * most->force / earth));
  const bool heavy_bridge =
      look.scene.beam && is_bridge(*look.scene.beam) && look.scene.beam->mass.minimum() >= lightest_bridge &&
      *std::min_element(look.scene.beam->spans.begin(), look.scene.beam->spans.end()) >= bridge_from;
  if (heavy_bridge && most->force < lightest_axle * earth)
    lines.push_back(
        fmt::format("{}: {:.3g} N is the most that any wheel or force puts on the bridge; as if {} were "
                    "given in {}",
                    most->name, most->force, most->type < 0 ? "forces" : "masses",
                    most->type < 0 ? "kN, they are in N" : "t, they are in kg"));
  double sum = 0.0;
  for (const Axle& axle : axles) sum += axle.force;
  if (least->type >= 0 && sum > 0.0 && least->force < one_share * sum / static_cast<double>(axles.size()))
    lines.push_back(fmt::format("vehicle {}, {}: carries {:.3g} N at rest, the others {:.4g} kN in the mean",
                                least->vehicle, least->name, least->force,
                                1e-3 * sum / static_cast<double>(axles.size())));
}

void look_at_speed(const Look& look, Lines& lines) {
  const bool swept = look.whole.sweep && !look.whole.sweep->speeds.empty();
  const double speed = swept ? look.whole.sweep->speeds.back() : greatest_speed(look.scene);
  if (speed > fast && speed <= noted_as_fast)
    lines.push_back(
        fmt::format("{:g} m/s is {:g} km/h, which no train runs at in service; speeds are in m/s", speed, 3.6 * speed));
}

void look_at_course(const Look& look, const std::vector<Axle>& axles, Lines& lines) {
  if (!look.scene.beam || axles.empty()) return;
  const auto by_place = [](const Axle& a, const Axle& b) { return a.x < b.x; };
  const auto [last, first] = std::minmax_element(axles.begin(), axles.end(), by_place);
  const bool moves = look.scene.analysis == Analysis::transient;
  const bool rests = !moves || greatest_speed(look.scene) == 0.0;
  const double start = look.scene.beam->start - (look.scene.beam->track ? look.scene.beam->track->approach : 0.0);
  if (rests && look.scene.analysis != Analysis::static_envelope && first->x < start)
    lines.push_back(fmt::format("the train never meets the bridge: it stands {:g} m before it", start - first->x));
  const double leaves = look.passage->system().leaving_time();
  if (moves && !rests && std::isfinite(leaves) && look.end_time() < leaves * nearly_all &&
      first->x + greatest_speed(look.scene) * look.end_time() > start)
    lines.push_back(
        fmt::format("the run ends at {:.4g} s, before the last {} has left the bridge at {:.4g} s (ts_max_time)",
                    look.end_time(), last->type < 0 ? "force" : "wheel", leaves));
}

void look_at_gravity(const Look& look, Lines& lines) {
  const bool rolls = look.passage && !look.passage->system().fleet().wheels.empty();
  if (rolls && std::abs(look.scene.gravity - earth) > near_earth)
    lines.push_back(fmt::format("gravity: {:g} m/s2, on earth it is 9.81 m/s2", look.scene.gravity));
}

}  // namespace

std::vector<std::string> unusual_in(const Look& look, const std::vector<Axle>& axles, const Rest& rest) {
  Lines lines = look.whole.unusual;
  for (const std::string& note : look.whole.notes)
    if (note.find(" has no effect") != std::string::npos) lines.push_back(note);
  if (look.scene.beam) {
    look_at_frequency(look, lines);
    look_at_weight(look, lines);
    look_at_damping(look, lines);
    look_at_deflection(rest, lines);
    look_at_steps(look, rest, lines);
  }
  look_at_gravity(look, lines);
  look_at_axles(look, axles, lines);
  look_at_speed(look, lines);
  look_at_course(look, axles, lines);
  return lines;
}

}  // namespace traverse::app
