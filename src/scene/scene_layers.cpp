// Reads the layered track of a scene: rail, pads, sleepers, ballast and sub-ballast.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double least_track_length = 30.0;  // m
constexpr double track_margin = 12.0;  // m behind the last wheel at the start and before the first wheel at the end

/// The length of track on either side with which the whole train is on the track at the start and at the end.
double approach_of(const Scene& scene) {
  double rear = 0.0;
  for (const double x : wheels_at_start(scene)) rear = std::min(rear, x);
  for (const double x : scene.load.positions) rear = std::min(rear, x);
  if (!scene.train.courses.empty() || !scene.load.courses.empty()) {  // trains to the left begin at the other end
    std::vector<double> all = wheels_at_start(scene);
    all.insert(all.end(), scene.load.positions.begin(), scene.load.positions.end());
    for (const double x : all) rear = std::min(rear, scene.beam->length() - x);
  }
  return std::max(least_track_length,
                  std::ceil(-rear + greatest_speed(scene) * scene.tail.value_or(0.0) + track_margin));
}

beam::Layer read_layer(const Options& o, const std::string& name) {
  return {read_distribution(o, "track_" + name + "_k"), read_distribution(o, "track_" + name + "_c")};
}

/// A layer that exists if its stiffness is given.
std::optional<beam::Layer> read_optional_layer(const Options& o, const std::string& name) {
  return o.has("track_" + name + "_k") ? std::optional(read_layer(o, name)) : std::nullopt;
}

/// Reads a part of the track with different properties (TrackStretch). The layers of the track have been read before.
beam::TrackStretch read_stretch(const Options& o, const std::string& name, const beam::LayeredTrack& track) {
  const std::string prefix = "track_" + name + "_";
  beam::TrackStretch stretch{name, o.number(prefix + "from"), o.number(prefix + "to"), {}, true};
  if (stretch.to < stretch.from)
    o.refuse(prefix + "to", fmt::format("allowed: not below {}from, {:g} m", prefix, stretch.from));
  stretch.sleepers = o.choice(prefix + "sleepers") != "none";
  for (std::size_t i = 0; i < beam::track_property_count; ++i) {
    const beam::TrackProperty& property = beam::track_properties[i];
    const std::string option = prefix + std::string(property.name);
    if (!o.has(option)) continue;
    if (property.along(track) == nullptr) {
      const std::string_view layer = property.name.substr(0, property.name.find('_'));
      o.refuse(option, fmt::format("the track has no {}, which needs track_{}_k", layer, layer));
    }
    stretch.values[i] = read_distribution(o, option);
  }
  return stretch;
}

/// The stations of items at nodes of the rail, in ascending order. The number of rail elements is then fixed.
std::vector<double> read_at_nodes(const Options& o, const char* option, const char* things, Scene& scene,
                                  const beam::LayeredTrack& track) {
  if (!o.has(option)) return {};
  std::vector<double> stations = o.numbers(option);
  std::sort(stations.begin(), stations.end());
  if (scene.mesh_open)
    scene.notes.push_back(fmt::format("the rail has {} elements per bay, because its {} ({}) are at nodes",
                                      track.elements_per_bay, things, option));
  scene.mesh_open = false;
  return stations;
}

}  // namespace

void declare_stretches(Options& o) { declare_named(o, "track_stretches", "track", "stretch", options::stretch_rows()); }

void read_layers(const Options& o, Scene& scene) {
  if (!o.has("track_rail_EI")) return;
  beam::LayeredTrack track;
  track.rail_EI = read_distribution(o, "track_rail_EI");
  if (o.has("track_rail_EA")) track.rail_EA = read_distribution(o, "track_rail_EA");
  track.rail_GA = o.optional_number("track_rail_GA");
  track.rail_mass = read_distribution(o, "track_rail_mass");
  track.spacing = o.number("track_spacing");
  track.offset = std::fmod(o.number("track_offset"), track.spacing);
  track.elements_per_bay = o.integer("track_elements_per_bay");
  scene.mesh_open = !o.has("track_elements_per_bay");
  track.rail_hinges = read_at_nodes(o, "track_rail_hinges", "joints", scene, track);
  track.expansion_devices = read_at_nodes(o, "track_rail_expansion_devices", "expansion devices", scene, track);
  track.pad = read_layer(o, "pad");
  track.sleeper_mass = read_distribution(o, "track_sleeper_mass");
  track.ballast = read_optional_layer(o, "ballast");
  if (track.ballast) track.ballast_mass = read_distribution(o, "track_ballast_mass");
  track.subballast = read_optional_layer(o, "subballast");
  if (o.has("track_longitudinal_k")) track.longitudinal.k = read_distribution(o, "track_longitudinal_k");
  track.longitudinal.c = read_distribution(o, "track_longitudinal_c");
  track.slides_at = read_distribution(o, "track_longitudinal_limit");
  track.loaded_k = read_distribution(o, "track_longitudinal_loaded_k");
  track.loaded_slides_at = read_distribution(o, "track_longitudinal_loaded_limit");
  track.rail_temperature = o.number("track_rail_temperature");
  track.rail_expansion = o.number("track_rail_expansion");
  track.rail_ends_held = o.choice("track_rail_ends") == "held";
  track.gap = read_distribution(o, "track_gap");
  track.own_mass = o.flag("track_ballast_own_mass");
  track.shear = {o.number("track_shear_k"), o.number("track_shear_c")};
  if (o.has("track_stretches"))
    for (const std::string& name : o.texts("track_stretches")) track.stretches.push_back(read_stretch(o, name, track));
  const auto approach = o.optional_number("track_approach");
  track.approach = approach.value_or(approach_of(scene));
  if (!approach)
    scene.notes.push_back(
        fmt::format("track: {:g} m on either side, so that the whole train is on it at the start "
                    "and at the end; -track_approach changes it",
                    track.approach));
  if (o.has("beam_elements_per_span"))
    scene.notes.emplace_back(
        "beam_elements_per_span has no effect on the run: the rail's elements set the bridge's "
        "mesh (track_elements_per_bay)");
  scene.beam->track = track;
}

}  // namespace traverse::scene
