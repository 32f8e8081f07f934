// Reads a bridge with given modes, and refuses the options that need a beam of elements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "given_modes.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr const char* needs_elements = "needs a bridge of elements (beam_spans); bridge_modes_file has only modes";

/// Refuses the options of a beam, of its supports and of a layered track.
void refuse_elements(const Options& o) {
  for (const char* prefix : {"beam_", "support_", "foundation_", "track_rail", "track_pad", "track_sleeper",
                             "track_ballast", "track_subballast", "track_longitudinal", "norm_"})
    if (const options::Entry* entry = o.first_with_prefix(prefix)) o.refuse(entry->name, needs_elements);
  for (const char* name : {"model_axial", "model_damping_ratios", "model_damping_bound", "model_additional_damping"})
    if (o.has(name)) o.refuse(name, "is not allowed with bridge_modes_file, which defines the modes and their damping");
}

}  // namespace

bool read_given_bridge(const Options& o, Scene& scene) {
  if (!o.has("bridge_modes_file")) {
    if (o.has("bridge_track")) o.refuse("bridge_track", "needs bridge_modes_file");
    return false;
  }
  refuse_elements(o);
  if (scene.analysis != Analysis::transient && scene.analysis != Analysis::modes)
    o.refuse("scene_analysis",
             fmt::format("{} {}; allowed: transient or modes", o.text("scene_analysis"), needs_elements));
  scene.beam = beam::bridge_of(read_given_modes(o.path("bridge_modes_file"), o.integer("bridge_track")));
  return true;
}

void read_modes_of_given(const Options& o, Scene& scene) {
  const std::string value = o.text("model_modes");
  const std::size_t available = scene.beam->given->omega.size();
  char* end = nullptr;
  const double requested = value == "auto" ? static_cast<double>(available) : std::strtod(value.c_str(), &end);
  if (!(requested >= 1.0 && requested <= static_cast<double>(available)) || (end != nullptr && *end != 0) ||
      requested != std::floor(requested))
    o.refuse(
        "model_modes",
        fmt::format("allowed with bridge_modes_file: auto, or the number of the lowest modes, up to {}", available));
  if (scene.analysis == Analysis::transient) scene.model.modes = static_cast<int>(requested);
  if (scene.model.window_tolerance > 0.0)
    scene.notes.emplace_back("model_window has no effect: with modes the bridge has no parts that could be excluded");
  for (const options::VerdictLimit& limit : scene.limits)
    if (limit.quantity == "deflection_over_span" ||
        options::limit_quantity(limit.quantity)->finder != options::LimitFinder::run)
      o.refuse("limits", fmt::format("{} {}", limit.quantity, needs_elements));
}

}  // namespace traverse::scene
