// A bridge by given modes: what the scene takes of them, and what needs a beam's elements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "given_modes.hpp"
#include "scene_parts.hpp"

namespace traverse::app {
namespace {

using options::Options;

constexpr const char* needs_elements =
    "needs a bridge by its elements (beam_spans); bridge_modes_file gives modes alone";

/// Options of a beam and of what stands on or under one.
void refuse_elements(const Options& o) {
  for (const char* prefix : {"beam_", "support_", "foundation_", "track_rail", "track_pad", "track_sleeper",
                             "track_ballast", "track_subballast", "track_longitudinal", "norm_"})
    if (const options::Entry* entry = o.first_with_prefix(prefix)) o.refuse(entry->name, needs_elements);
  for (const char* name : {"model_axial", "model_damping_ratios", "model_damping_bound", "model_additional_damping"})
    if (o.has(name))
      o.refuse(name, "has no place beside bridge_modes_file, which says how the modes move and are damped");
}

}  // namespace

bool read_given_bridge(const Options& o, Scene& scene) {
  if (!o.has("bridge_modes_file")) {
    if (o.has("bridge_track")) o.refuse("bridge_track", "needs bridge_modes_file, whose track it is");
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
  const std::size_t there = scene.beam->given->omega.size();
  char* end = nullptr;
  const double wanted = value == "auto" ? static_cast<double>(there) : std::strtod(value.c_str(), &end);
  if (!(wanted >= 1.0 && wanted <= static_cast<double>(there)) || (end != nullptr && *end != 0) ||
      wanted != std::floor(wanted))
    o.refuse("model_modes",
             fmt::format("allowed with bridge_modes_file: auto, or a number of the lowest modes up to {}", there));
  if (scene.analysis == Analysis::transient) scene.model.modes = static_cast<int>(wanted);
  if (scene.model.rest_tolerance > 0.0)
    scene.notes.emplace_back("model_window has no effect: a bridge by its modes moves as a whole");
  for (const options::VerdictLimit& limit : scene.limits)
    if (limit.quantity == "deflection_over_span" ||
        options::limit_quantity(limit.quantity)->finder != options::LimitFinder::run)
      o.refuse("limits", fmt::format("{} {}", limit.quantity, needs_elements));
}

}  // namespace traverse::app
