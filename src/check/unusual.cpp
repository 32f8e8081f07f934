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

constexpr double fast_speed = 150.0, reported_speed = 160.0;   // m/s; above the latter the scene's reader reports it
constexpr double heaviest_axle = 40e3, lightest_axle = 100.0;  // kg
constexpr double min_bridge_span = 4.0;                        // m: shortest span of a bridge
constexpr double lightest_bridge = 50.0;                       // kg/m, of a bridge
constexpr double unit_ratio = 31.6227766;  // ratio of frequencies for a factor of 1000 in EI or mass
constexpr double bounds_margin = 2.0;      // factor of the bounds
constexpr double high_damping = 0.1;
constexpr double large_deflection = 1.0 / 300.0;   // relative to the span
constexpr double reported_step = 1e-4;             // m: jump of the running surface
constexpr double earth = 9.81, near_earth = 0.05;  // m/s2
constexpr double min_time_share = 0.99;            // relative to the time until the train has left
constexpr double min_load_share = 1e-3;            // relative to the mean: smallest wheel load

/// Whether the beam has supported spans, as in figure 6.10 of EN 1991-2.
bool is_bridge(const beam::BeamModel& beam) {
  const bool supported = std::all_of(beam.supports.begin(), beam.supports.end(), beam::fixes_vertical);
  return supported && beam.foundation.vertical.empty() && !beam.foundation.vertical_bed && beam.hinges.empty() &&
         beam.cracks.empty();
}

bool between(double value, const std::pair<double, double>& bounds, double slack) {
  return value >= bounds.first / slack && value <= bounds.second * slack;
}

void check_frequency(const FirstRun& run, Lines& lines) {
  const beam::BeamModel& beam = *run.scene.beam;
  if (run.frequencies.empty() || !is_bridge(beam)) return;
  const std::vector<double> lengths = norm::determinant_lengths(beam);
  const double length = *std::max_element(lengths.begin(), lengths.end()), n0 = run.frequencies.front();
  const auto bounds = norm::frequency_bounds(length);
  if (!bounds || between(n0, *bounds, 1.0)) return;
  std::string line = fmt::format(
      "the first frequency, {:.3g} Hz, is {} the range of railway bridges of {:.3g} m: {:.3g} to {:.3g} Hz "
      "(EN 1991-2, figure 6.10)",
      n0, n0 < bounds->first ? "below" : "above", length, bounds->first, bounds->second);
  if (!between(n0, *bounds, bounds_margin) && between(n0 * unit_ratio, *bounds, bounds_margin))
    line += "; beam_EI is possibly given in kN m2; its unit is N m2";
  else if (!between(n0, *bounds, bounds_margin) && between(n0 / unit_ratio, *bounds, bounds_margin))
    line += "; beam_mass is possibly given in t/m; its unit is kg/m";
  lines.push_back(line);
}

void check_mass(const FirstRun& run, Lines& lines) {
  const beam::BeamModel& beam = *run.scene.beam;
  const double span = *std::min_element(beam.spans.begin(), beam.spans.end());
  if (is_bridge(beam) && span >= min_bridge_span && beam.mass.maximum() < lightest_bridge)
    lines.push_back(fmt::format("beam_mass: {:g} kg/m is small for spans of {:g} m; it is possibly given in t/m",
                                beam.mass.maximum(), span));
}

void check_damping(const FirstRun& run, Lines& lines) {
  const Damping& damping = run.scene.damping;
  double ratio = damping.ratios ? std::max(damping.ratios->first, damping.ratios->second) : 0.0;
  for (const double one : run.scene.damping_of_modes) ratio = std::max(ratio, one);
  if (run.scene.by_given_modes())
    for (const double one : run.scene.beam->given->ratio) ratio = std::max(ratio, one);
  if (ratio > high_damping)
    lines.push_back(fmt::format("a damping ratio of {:g} is {:g} % of critical damping, bridges have 0.5 to 3 %", ratio,
                                100.0 * ratio));
}

void check_deflection(const StaticResponse& response, Lines& lines) {
  if (response.span > 0.0 && response.deflection > large_deflection * response.span)
    lines.push_back(fmt::format(
        "the static deflection of the bridge is {:.3g} m at x = {:g} m, 1/{:.0f} of its span; beam_EI or the loads "
        "are possibly in other units",
        response.deflection, response.at, response.span / response.deflection));
}

void check_surface_steps(const FirstRun& run, const StaticResponse& response, Lines& lines) {
  if (run.passage == nullptr || run.passage->system().fleet().wheels.empty()) return;
  for (const SurfaceStep& step : response.steps)
    if (step.height > reported_step)
      lines.push_back(fmt::format(
          "the running surface has a step of up to {:.3g} mm at x = {:g} m, because no rigid support joins both "
          "sides: wheels impact its edge",
          1e3 * step.height, step.x));
}

void check_axles(const FirstRun& run, const std::vector<Axle>& axles, Lines& lines) {
  if (axles.empty() || !(run.scene.gravity > 0.0)) return;
  const auto by_force = [](const Axle& a, const Axle& b) { return a.force < b.force; };
  const auto [least, most] = std::minmax_element(axles.begin(), axles.end(), by_force);
  if (most->force > heaviest_axle * earth)
    lines.push_back(fmt::format("{}: {:.4g} kN, {:.3g} t, on one axle; the heaviest on rails carry 40 t", most->name,
                                1e-3 * most->force, 1e-3 * most->force / earth));
  const bool heavy_bridge =
      run.scene.beam && is_bridge(*run.scene.beam) && run.scene.beam->mass.minimum() >= lightest_bridge &&
      *std::min_element(run.scene.beam->spans.begin(), run.scene.beam->spans.end()) >= min_bridge_span;
  if (heavy_bridge && most->force < lightest_axle * earth)
    lines.push_back(fmt::format("{}: the largest load of a wheel or force is {:.3g} N; {} are possibly given in {}",
                                most->name, most->force, most->type < 0 ? "forces" : "masses",
                                most->type < 0 ? "kN; the unit is N" : "t; the unit is kg"));
  double sum = 0.0;
  for (const Axle& axle : axles) sum += axle.force;
  if (least->type >= 0 && sum > 0.0 && least->force < min_load_share * sum / static_cast<double>(axles.size()))
    lines.push_back(fmt::format("vehicle {}, {}: the static wheel load is {:.3g} N, the mean of all wheels {:.4g} kN",
                                least->vehicle, least->name, least->force,
                                1e-3 * sum / static_cast<double>(axles.size())));
}

void check_speed(const FirstRun& run, Lines& lines) {
  const bool swept = run.whole.sweep && !run.whole.sweep->speeds.empty();
  const double speed = swept ? run.whole.sweep->speeds.back() : greatest_speed(run.scene);
  if (speed > fast_speed && speed <= reported_speed)
    lines.push_back(
        fmt::format("{:g} m/s is {:g} km/h, faster than any train in service; speeds are in m/s", speed, 3.6 * speed));
}

void check_position(const FirstRun& run, const std::vector<Axle>& axles, Lines& lines) {
  if (!run.scene.beam || axles.empty()) return;
  const auto by_place = [](const Axle& a, const Axle& b) { return a.x < b.x; };
  const auto [last, first] = std::minmax_element(axles.begin(), axles.end(), by_place);
  const bool moves = run.scene.analysis == Analysis::transient;
  const bool at_rest = !moves || greatest_speed(run.scene) == 0.0;
  const double start = run.scene.beam->start - (run.scene.beam->track ? run.scene.beam->track->approach : 0.0);
  if (at_rest && run.scene.analysis != Analysis::static_envelope && first->x < start)
    lines.push_back(fmt::format("the train does not reach the bridge: it stands {:g} m before it", start - first->x));
  const double leaves = run.passage->system().leaving_time();
  if (moves && !at_rest && std::isfinite(leaves) && run.end_time() < leaves * min_time_share &&
      first->x + greatest_speed(run.scene) * run.end_time() > start)
    lines.push_back(
        fmt::format("the run ends at {:.4g} s, before the last {} has left the bridge at {:.4g} s (ts_max_time)",
                    run.end_time(), last->type < 0 ? "force" : "wheel", leaves));
}

void check_gravity(const FirstRun& run, Lines& lines) {
  const bool has_wheels = run.passage && !run.passage->system().fleet().wheels.empty();
  // Across an inclined beam gravity has a component only.
  const double gravity = run.scene.gravity * (run.scene.beam ? std::hypot(1.0, run.scene.beam->gradient) : 1.0);
  if (has_wheels && std::abs(gravity - earth) > near_earth)
    lines.push_back(fmt::format("gravity: {:g} m/s2, on earth it is 9.81 m/s2", gravity));
}

}  // namespace

std::vector<std::string> unusual_in(const FirstRun& run, const std::vector<Axle>& axles,
                                    const StaticResponse& response) {
  Lines lines = run.whole.unusual;
  for (const std::string& note : run.whole.notes)
    if (note.find(" has no effect") != std::string::npos) lines.push_back(note);
  if (run.scene.beam) {
    check_frequency(run, lines);
    check_mass(run, lines);
    check_damping(run, lines);
    check_deflection(response, lines);
    check_surface_steps(run, response, lines);
  }
  check_gravity(run, lines);
  check_axles(run, axles, lines);
  check_speed(run, lines);
  check_position(run, axles, lines);
  return lines;
}

}  // namespace traverse::app
