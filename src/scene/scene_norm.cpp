// Reads the options of EN 1991-2, load models, the check of 6.4.6.5 and lower bounds of damping, and the loads of UIC
// 774-3 for the track-bridge interaction.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "norm/en1991.hpp"
#include "norm/static_bridge.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double most_sections = 1e5;

options::BridgeMaterial material_of(const std::string& name) {
  const auto* row = std::find_if(std::begin(options::damping_bounds), std::end(options::damping_bounds),
                                 [&](const options::DampingBound& one) { return one.name == name; });
  return static_cast<options::BridgeMaterial>(row - std::begin(options::damping_bounds));
}

/// The option that requires static effects; empty if none does.
std::string option_of_static_effects(const Options& o, const Scene& scene) {
  if (o.has("norm_load_models")) return "norm_load_models";
  if (scene.analysis == Analysis::static_envelope) return "scene_analysis";
  const bool limited = std::any_of(scene.limits.begin(), scene.limits.end(), [](const options::VerdictLimit& limit) {
    return options::limit_quantity(limit.quantity)->finder == options::LimitFinder::norm;
  });
  return limited ? "limits" : "";
}

using options::RailLoads;

constexpr double most_fronts = 1e4;
constexpr double behind_the_bridge = 90.0, step_of_fronts = 10.0;  // m

/// The positions of the train's front, from the given first, last and step or from the length of the bridge.
std::vector<double> read_fronts(const Options& o, double length) {
  std::vector<double> given = {0.0, length + behind_the_bridge, step_of_fronts};
  if (o.has("uic774_fronts")) given = o.numbers("uic774_fronts");
  const double steps = (given[1] - given[0]) / given[2];
  if (!(given[2] > 0.0) || !(steps >= 0.0) || steps > most_fronts)
    o.refuse(
        "uic774_fronts",
        fmt::format("allowed: first, last, step, with last not below first and at most {:g} positions", most_fronts));
  std::vector<double> fronts;
  for (int i = 0; i <= std::floor(steps + 1e-9); ++i) fronts.push_back(given[0] + i * given[2]);
  return fronts;
}

}  // namespace

void read_damping_bound(const Options& o, Scene& scene) {
  if (!o.has("model_damping_bound")) return;
  const double span = *std::max_element(scene.beam->spans.begin(), scene.beam->spans.end());
  const double least = norm::least_damping(material_of(o.choice("model_damping_bound")), span);
  const double more = o.flag("model_additional_damping") ? norm::additional_damping(span) : 0.0;
  const double ratio = least + more;
  scene.notes.push_back(fmt::format("damping {:.4g} %: EN 1991-2 table 6.6, {}, span {:g} m{}", 100.0 * ratio,
                                    o.choice("model_damping_bound"), span,
                                    more > 0.0 ? fmt::format(", with {:.3g} % by 6.4.6.4", 100.0 * more) : ""));
  scene.damping.ratios = {ratio, ratio};  // of the first two modes of a bridge by elements
  scene.damping_of_modes = {ratio};
}

void read_norm(const Options& o, Scene& scene) {
  const std::string asked = option_of_static_effects(o, scene);
  if (asked.empty()) {
    for (const char* name : {"norm_alpha", "norm_track", "norm_length", "norm_spacing", "norm_lane_load", "norm_range",
                             "norm_second_track"})
      if (o.has(name))
        scene.notes.push_back(std::string(name) + " has no effect: norm_load_models names no load model");
    return;
  }
  if (!scene.beam) o.refuse(asked, "static effects need a bridge (beam_spans)");
  if (scene.analysis != Analysis::transient && scene.analysis != Analysis::static_envelope) {
    scene.notes.push_back(
        asked + " has no effect: static effects are computed in transient runs and with scene_analysis envelope");
    return;
  }
  if (several_courses(scene))
    o.refuse(asked, "static effects are computed for one train or load; several are given (trains, loads)");
  if (scene.tracks.size() > 2) {
    const std::string why = "load models stand on two tracks at most, and tracks has more names";
    if (asked != "limits") o.refuse(asked, why);
    scene.notes.push_back(asked + ": " + why + "; there is no verdict of EN 1991-2");
    return;
  }
  if (!scene.tracks.empty() && o.has("norm_second_track"))
    o.refuse("norm_second_track", "the second track is that which tracks names");
  if (!only_axle_loads(scene.load)) {
    const std::string why = "static effects are computed for constant concentrated forces";
    if (asked == "scene_analysis") o.refuse(asked, why);
    scene.notes.push_back(asked + ": " + why + "; there is no verdict of EN 1991-2");
    return;
  }
  if (scene.beam->foundation.nonlinear()) {
    const std::string why =
        "influence lines are not valid: the foundation is one-sided, slides, has a gap or a cubic term";
    if (asked == "scene_analysis") o.refuse(asked, why);
    scene.notes.push_back(asked + ": " + why + "; static effects and the verdict of EN 1991-2 are not computed");
    return;
  }
  o.check_at_most(asked, static_cast<double>(scene.beam->spans.size()), norm::StaticBridge::most_spans,
                  "spans with static effects");
  options::NormRules rules;
  if (o.has("norm_load_models"))
    rules.load_models = o.texts("norm_load_models");
  else if (asked == "limits" || !scene.limits.empty())
    rules.load_models = {"lm71"};
  if (o.has("norm_second_track"))
    rules.second_track = o.number("norm_second_track") - scene.beam->torsion->shear_centre;
  for (const Track& track : scene.tracks)
    if (track.line != scene.beam->torsion->tracks.front()) rules.second_track = track.line.lever + track.line.shift;
  rules.alpha = o.number("norm_alpha");
  rules.careful = o.choice("norm_track") == "careful";
  rules.length = o.optional_number("norm_length");
  rules.spacing = o.optional_number("norm_spacing").value_or(0.0);
  rules.lane_load = o.number("norm_lane_load");
  if (o.has("norm_range")) {
    const std::vector<double> range = o.numbers("norm_range");
    if (!(range[0] <= range[1])) o.refuse("norm_range", "allowed: from, to, with to not below from");
    rules.range = {range[0], range[1]};
  }
  const std::vector<double> gap = o.numbers("norm_lane_gap");
  rules.lane_gap_from = gap[0];
  rules.lane_gap_to = gap[1];
  if (gap[1] < gap[0]) o.refuse("norm_lane_gap", "allowed: from, to, with to not below from");
  if (rules.spacing > 0.0)
    o.check_at_most("norm_spacing", scene.beam->length() / rules.spacing, most_sections, "sections");
  scene.norm = rules;
  if (scene.self_weight && scene.analysis == Analysis::transient)
    scene.notes.emplace_back(
        "beam_self_weight: peaks include the bridge's own weight, so there is no verdict of EN 1991-2 6.4.6.5");
  else if (scene.beam->strained() && scene.analysis == Analysis::transient)
    scene.notes.emplace_back(
        "peaks include the effects of temperature and settlements, so there is no verdict of EN 1991-2 6.4.6.5");
  if (scene.beam->track)
    scene.notes.emplace_back("static effects: loads act directly on the bridge, without distribution by the track");
}

void read_rail_loads(const Options& o, Scene& scene) {
  if (scene.analysis != Analysis::rail_forces) return;
  if (!scene.beam->axial) o.refuse("scene_analysis", "rail needs beam_EA, track_rail_EA and track_longitudinal_k");
  if (!scene.vehicles.empty() || !scene.load.forces.empty())
    scene.notes.emplace_back(
        "scene_analysis rail: the train is that of uic774_train_length; vehicles and moving "
        "forces have no effect");
  RailLoads loads;
  loads.length = o.number("uic774_train_length");
  loads.weight = o.number("uic774_weight");
  loads.braking = o.number("uic774_braking");
  loads.most_braking = o.number("uic774_most_braking");
  loads.traction = o.number("uic774_traction");
  loads.most_traction = o.number("uic774_most_traction");
  loads.fronts = read_fronts(o, scene.beam->length());
  const std::string direction = o.choice("uic774_direction");
  loads.runs = direction == "left"   ? options::Runs::to_the_left
               : direction == "both" ? options::Runs::both_ways
                                     : options::Runs::to_the_right;
  loads.rail_area = o.number("track_rail_area");
  const beam::RailMesh rail = beam::rail_mesh(*scene.beam);
  const double before = -rail.start, behind = rail.x(rail.elements) - scene.beam->length();
  const double rear = loads.length - loads.fronts.front(), front = loads.fronts.back() - scene.beam->length();
  const double needed = std::max(rear, front);
  if (std::min(before, behind) < needed * (1.0 - 1e-9))
    o.refuse("track_approach",
             fmt::format("the train would extend beyond the modelled track (uic774_train_length, uic774_fronts); "
                         "allowed: at least {:g} m",
                         needed));
  scene.rail_loads = loads;
}

}  // namespace traverse::scene
