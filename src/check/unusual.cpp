// Compares input with usual ranges, among them the bounds of the first natural frequency of railway bridges in figure
// 6.10 of EN 1991-2, and suggests which unit may have been confused. Support reactions under the bridge's own weight
// and under the most unfavourable positions of the trains, and the largest static deflection at mid-span, follow from
// influence lines.
#include "unusual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "norm/en1991.hpp"
#include "norm/static_bridge.hpp"
#include "results/stage.hpp"
#include "run/norm_run.hpp"
#include "traverse/base/error.hpp"

namespace traverse::check {
namespace {

using Lines = std::vector<std::string>;

constexpr double large_deflection = 1.0 / 300.0;  // relative to the span
constexpr double reported_step = 1e-4;            // m: jump of the running surface
constexpr double near_earth = 0.05;               // m/s2
constexpr double min_time_share = 0.99;           // relative to the time until the train has left
constexpr double min_load_share = 1e-3;           // relative to the mean: smallest wheel load
constexpr double heaviest_walker = 5e3;           // N: heaviest load on a footbridge
constexpr double far_from_place = 1.0;            // m
constexpr double soft_contact = 0.7;              // of the stiffness of the springs above

/// Whether the beam has supported spans, as in figure 6.10 of EN 1991-2.
bool is_bridge(const beam::BeamModel& beam) {
  const bool supported = std::all_of(beam.supports.begin(), beam.supports.end(), beam::fixes_vertical);
  return supported && beam.foundation.vertical.empty() && !beam.foundation.vertical_bed && beam.hinges.empty() &&
         beam.cracks.empty();
}

void say(const std::string& line, Lines& lines) {
  if (!line.empty()) lines.push_back(line);
}

double greatest_force(const std::vector<Axle>& axles) {
  double greatest = 0.0;
  for (const Axle& axle : axles) greatest = std::max(greatest, axle.force);
  return greatest;
}

/// Whether people cross the bridge: figure 6.10 is for railway bridges.
bool is_footbridge(const std::vector<Axle>& axles) {
  const double force = greatest_force(axles);
  return force < heaviest_walker && !norm::is_possibly_in_kilonewtons(force) && !axles.empty();
}

void check_frequency(const beam::BeamModel& beam, double n0, Lines& lines) {
  const std::vector<double> lengths = norm::determinant_lengths(beam);
  say(norm::unusual_frequency(n0, *std::max_element(lengths.begin(), lengths.end()), "beam_EI", "beam_mass"), lines);
}

void check_mass(const beam::BeamModel& beam, Lines& lines) {
  const double span = *std::min_element(beam.spans.begin(), beam.spans.end());
  say(norm::unusual_bridge_mass(beam.mass.maximum(), span, "beam_mass"), lines);
}

/// The greatest damping ratio of the first mode, as far as the scene gives it. n0: its frequency, Hz.
double damping_ratio(const scene::Scene& scene, double n0) {
  const auto greatest = [](const std::vector<double>& ratios) {
    return ratios.empty() ? 0.0 : *std::max_element(ratios.begin(), ratios.end());
  };
  const scene::Damping& damping = scene.damping;
  double ratio = greatest(scene.damping_of_modes);
  if (scene.by_given_modes()) ratio = std::max(ratio, greatest(scene.beam->given->ratio));
  if (damping.ratios) ratio = std::max({ratio, damping.ratios->first, damping.ratios->second});
  const double omega = 2.0 * std::numbers::pi * n0;
  if (damping.rayleigh && omega > 0.0)
    ratio = std::max(ratio, 0.5 * (damping.rayleigh->first / omega + damping.rayleigh->second * omega));
  return ratio;
}

void check_bridge(const SceneAtRest& rest, const std::vector<Axle>& axles, Lines& lines) {
  const beam::BeamModel& beam = *rest.scene.beam;
  const bool bridge = is_bridge(beam);
  const double n0 = bridge || rest.scene.damping.rayleigh ? rest.first_frequency() : 0.0;
  if (bridge && !is_footbridge(axles)) check_frequency(beam, n0, lines);
  if (bridge) check_mass(beam, lines);
  say(norm::unusual_damping(damping_ratio(rest.whole, n0)), lines);
}

void check_deflection(const StaticResponse& response, Lines& lines) {
  if (response.span > 0.0 && response.deflection > large_deflection * response.span)
    lines.push_back(fmt::format(
        "the static deflection of the bridge is {:.3g} m at x = {:g} m, 1/{:.0f} of its span; beam_EI or the loads "
        "are possibly in other units",
        response.deflection, response.at, response.span / response.deflection));
}

void check_surface_steps(const SceneAtRest& rest, const StaticResponse& response, Lines& lines) {
  if (!rest.system || rest.system->fleet().wheels.empty()) return;
  for (const SurfaceStep& step : response.steps)
    if (step.height > reported_step)
      lines.push_back(fmt::format(
          "the running surface has a step of up to {:.3g} mm at x = {:g} m, because no rigid support joins both "
          "sides: wheels impact its edge",
          1e3 * step.height, step.x));
}

void check_axles(const scene::Scene& scene, const std::vector<Axle>& axles, Lines& lines) {
  if (axles.empty() || !(scene.gravity > 0.0)) return;
  const auto by_force = [](const Axle& a, const Axle& b) { return a.force < b.force; };
  const auto [least, most] = std::minmax_element(axles.begin(), axles.end(), by_force);
  if (most->force > norm::heaviest_axle * norm::earth)
    lines.push_back(fmt::format("{}: {:.4g} kN, {:.3g} t, on one axle; the heaviest on rails carry 40 t", most->name,
                                1e-3 * most->force, 1e-3 * most->force / norm::earth));
  const bool heavy_bridge =
      scene.beam && scene.beam->mass.minimum() >= norm::lightest_bridge &&
      *std::min_element(scene.beam->spans.begin(), scene.beam->spans.end()) >= norm::min_bridge_span;
  if (heavy_bridge && norm::is_possibly_in_kilonewtons(most->force))
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

/// The readers of scenes check the speeds of all but studies.
void check_speed_of_study(const scene::Scene& given, const scene::Scene& whole, Lines& lines) {
  if (given.study && whole.sweep && !whole.sweep->speeds.empty())
    say(norm::unusual_speed("study_vary", whole.sweep->speeds.back()), lines);
}

void check_position(const SceneAtRest& rest, const std::vector<Axle>& axles, Lines& lines) {
  const scene::Scene& scene = rest.scene;
  if (!scene.beam || axles.empty()) return;
  const auto by_place = [](const Axle& a, const Axle& b) { return a.x < b.x; };
  const auto [last, first] = std::minmax_element(axles.begin(), axles.end(), by_place);
  const bool moves = scene.analysis == options::Analysis::transient;
  const bool at_rest = !moves || scene::greatest_speed(scene) == 0.0;
  const double start = scene.beam->start - (scene.beam->track ? scene.beam->track->approach : 0.0);
  if (at_rest && scene.analysis != options::Analysis::static_envelope && first->x < start)
    lines.push_back(fmt::format("the train does not reach the bridge: it stands {:g} m before it", start - first->x));
  const double leaves = rest.system->leaving_time();
  if (moves && !at_rest && std::isfinite(leaves) && scene.end_time && *scene.end_time < leaves * min_time_share &&
      first->x + scene::greatest_speed(scene) * *scene.end_time > start)
    lines.push_back(
        fmt::format("the run ends at {:.4g} s, before the last {} has left the bridge at {:.4g} s (ts_max_time)",
                    *scene.end_time, last->type < 0 ? "force" : "wheel", leaves));
}

void check_gravity(const SceneAtRest& rest, Lines& lines) {
  const bool has_wheels = rest.system && !rest.system->fleet().wheels.empty();
  // Across an inclined beam gravity has a component only.
  const double gravity = rest.scene.gravity * (rest.scene.beam ? std::hypot(1.0, rest.scene.beam->gradient) : 1.0);
  if (has_wheels && std::abs(gravity - norm::earth) > near_earth)
    lines.push_back(fmt::format("gravity: {:g} m/s2, on earth it is 9.81 m/s2", gravity));
}

/// The stiffness of the springs of a body across the track, N/m.
double vertical_stiffness(const multibody::MechanismModel& model, int body) {
  double sum = 0.0;
  for (const multibody::Spring& spring : model.springs) {
    if (spring.bodies[0] != body && spring.bodies[1] != body) continue;
    const Eigen::Vector2d axis = (spring.to - spring.from).stableNormalized();
    sum += spring.stiffness * axis.y() * axis.y();
  }
  return sum;
}

/// A wheel is stiffer than the springs above it, by a factor of ten for tyres and of a thousand for steel.
void check_contacts(const SceneAtRest& rest, Lines& lines) {
  if (!rest.system) return;
  const train::Fleet& fleet = rest.system->fleet();
  std::set<std::string> seen;
  for (std::size_t i = 0; i < fleet.wheels.size() && i < rest.weights().size(); ++i) {
    const train::WheelContact& c = fleet.wheels[i];
    const train::Wheel& wheel = fleet.wheel(c);
    const double force = rest.weights()[i].force;
    if (c.is_further || !(force > 0.0) || !seen.insert(wheel.name).second) continue;
    const contact::Kinematics pressed{contact::static_penetration(wheel.law, force), 0.0, 0.0};
    const double contact = contact::force(wheel.law, pressed, 0.0).normal_by_penetration,
                 springs = vertical_stiffness(fleet.vehicles[c.vehicle].mechanism.model(), c.body);
    if (contact < soft_contact * springs)
      lines.push_back(fmt::format(
          "{}: its contact is softer, {:.3g} N/m under its static load, than the springs above it, {:.3g} N/m; "
          "stiffnesses are in N/m, of a Hertz contact in N/m^1.5",
          wheel.name, contact, springs));
  }
}

void check_places(const SceneAtRest::Displaced& displaced, Lines& lines) {
  if (displaced.distance > far_from_place)
    lines.push_back(
        fmt::format("vehicle {}: at rest the body {} is {:.3g} m {} its position in the input; stiffnesses, masses, "
                    "radii or positions are possibly in other units",
                    displaced.vehicle, displaced.body, displaced.distance,
                    std::abs(displaced.up) < 0.5 * displaced.distance ? "beside"
                    : displaced.up < 0.0                              ? "below"
                                                                      : "above"));
}

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

/// The influence line of the deflection of the first track, for loads on it.
norm::InfluenceLine deflection_line(norm::StaticBridge& bridge, double x) {
  const std::optional<beam::Torsion>& torsion = bridge.model().torsion;
  return bridge.lines_at(x, torsion ? torsion->tracks.front().lever : 0.0).front().front();
}

void compute_deflection(norm::StaticBridge& bridge, const std::vector<norm::LoadModel>& trains,
                        StaticResponse& response) {
  double start = bridge.model().start;
  for (const double span : bridge.model().spans) {
    const double middle = start + 0.5 * span;
    const double deflection = greatest_of(deflection_line(bridge, middle).times(-1.0), trains);
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
  const norm::InfluenceLine line = deflection_line(bridge, x);
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
    const norm::InfluenceLine line = bridge.reaction(bearing).front();
    response.supports.push_back({bearing.x, bearing.span_end < 0, dead_load_effect(line, bridge.model(), gravity),
                                 -greatest_of(line.times(-1.0), trains), greatest_of(line, trains)});
  }
}

}  // namespace

std::vector<std::string> unusual_in(const scene::Scene& given, const SceneAtRest& rest, const std::vector<Axle>& axles,
                                    const StaticResponse& response) {
  Lines lines;
  if (rest.scene.beam) {
    check_bridge(rest, axles, lines);
    check_deflection(response, lines);
    check_surface_steps(rest, response, lines);
  }
  check_gravity(rest, lines);
  check_axles(rest.scene, axles, lines);
  check_contacts(rest, lines);
  check_places(rest.displaced, lines);
  check_speed_of_study(given, rest.whole, lines);
  check_position(rest, axles, lines);
  return lines;
}

std::vector<std::string> unusual_in(const scene::Scene& given) {
  try {
    const SceneAtRest rest(given);
    const std::vector<Axle> axles = axles_of(rest);
    return unusual_in(given, rest, axles, rest.scene.beam ? static_response(rest, false) : StaticResponse());
  } catch (const Error&) {
    return {};
  }
}

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
