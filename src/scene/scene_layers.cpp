// The layered track of a scene: rail, pads, sleepers, ballast and sub-ballast.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene_parts.hpp"

namespace traverse::app {
namespace {

using options::Options;

constexpr double least_approach = 30.0;  // m
constexpr double behind_train = 12.0;  // m of track behind the last wheel at the start, and before the first at the end

/// Track on either side long enough for the whole train to stand on it at the start and at the end.
double approach_of(const Scene& scene) {
  double rear = 0.0;
  for (const double x : wheels_at_start(scene)) rear = std::min(rear, x);
  for (const double x : scene.load.positions) rear = std::min(rear, x);
  if (!scene.train.courses.empty() || !scene.load.courses.empty()) {  // what runs to the left begins at the other end
    std::vector<double> all = wheels_at_start(scene);
    all.insert(all.end(), scene.load.positions.begin(), scene.load.positions.end());
    for (const double x : all) rear = std::min(rear, scene.beam->length() - x);
  }
  return std::max(least_approach, std::ceil(-rear + greatest_speed(scene) * scene.tail.value_or(0.0) + behind_train));
}

beam::Layer read_layer(const Options& o, const std::string& name) {
  return {o.number("track_" + name + "_k"), o.number("track_" + name + "_c")};
}

/// A layer is there when its stiffness is given.
std::optional<beam::Layer> read_optional_layer(const Options& o, const std::string& name) {
  const std::string k = "track_" + name + "_k";
  if (o.has(k)) return read_layer(o, name);
  for (const std::string& other : {"track_" + name + "_c", "track_" + name + "_mass"}) {
    if (o.has(other)) o.refuse(other, "needs " + k);
  }
  return std::nullopt;
}

}  // namespace

void read_layers(const Options& o, Scene& scene) {
  if (!o.has("track_rail_EI")) {
    for (const char* prefix :
         {"track_rail", "track_spacing", "track_offset", "track_pad", "track_sleeper", "track_ballast",
          "track_subballast", "track_longitudinal", "track_approach", "track_elements"}) {
      if (const options::Entry* entry = o.first_with_prefix(prefix))
        o.refuse(entry->name, "belongs to a layered track, which needs track_rail_EI");
    }
    return;
  }
  if (!scene.beam) o.refuse("track_rail_EI", "a layered track needs a bridge (beam_spans)");
  beam::LayeredTrack track;
  track.rail_EI = o.number("track_rail_EI");
  track.rail_EA = o.optional_number("track_rail_EA").value_or(0.0);
  track.rail_GA = o.optional_number("track_rail_GA");
  track.rail_mass = o.number("track_rail_mass");
  track.spacing = o.number("track_spacing");
  track.offset = std::fmod(o.number("track_offset"), track.spacing);
  track.elements_per_bay = o.integer("track_elements_per_bay");
  scene.mesh_open = !o.has("track_elements_per_bay");
  track.pad = {o.number("track_pad_k"), o.number("track_pad_c")};
  track.sleeper_mass = o.number("track_sleeper_mass");
  track.ballast = read_optional_layer(o, "ballast");
  track.ballast_mass = track.ballast ? o.number("track_ballast_mass") : 0.0;
  track.subballast = read_optional_layer(o, "subballast");
  track.longitudinal = {o.optional_number("track_longitudinal_k").value_or(0.0), o.number("track_longitudinal_c")};
  const auto approach = o.optional_number("track_approach");
  track.approach = approach.value_or(approach_of(scene));
  if (!approach)
    scene.notes.push_back(
        fmt::format("track: {:g} m on either side, so that the whole train stands on it at the start "
                    "and the end; -track_approach changes it",
                    track.approach));
  if (o.has("beam_elements_per_span"))
    scene.notes.emplace_back(
        "beam_elements_per_span has no effect on the run: the rail's elements set the bridge's "
        "mesh (track_elements_per_bay)");
  scene.beam->track = track;
}

}  // namespace traverse::app
