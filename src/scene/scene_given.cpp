// Reads a bridge with given modes, and refuses the options that need a beam of elements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "given_modes.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
using options::Options;

bool read_given_bridge(const Options& o, Scene& scene) {
  if (!o.has("bridge_modes_file")) return false;
  scene.beam = beam::bridge_of(read_given_modes(o.path("bridge_modes_file"), o.integer("bridge_track")));
  return true;
}

void read_modes_of_given(const Options& o, Scene& scene) {
  const auto available = static_cast<double>(scene.beam->given->omega.size());
  const double requested = o.optional_number("model_modes").value_or(available);
  if (!(requested >= 1.0 && requested <= available))
    o.refuse(
        "model_modes",
        fmt::format("allowed with bridge_modes_file: auto, or the number of the lowest modes, up to {}", available));
  if (scene.analysis == Analysis::transient) scene.model.modes = static_cast<int>(requested);
  if (scene.model.window_tolerance > 0.0)
    scene.notes.emplace_back("model_window has no effect: with modes the bridge has no parts that could be excluded");
  for (const options::VerdictLimit& limit : scene.limits)
    if (limit.quantity == "deflection_over_span" ||
        options::limit_quantity(limit.quantity)->finder != options::LimitFinder::run)
      o.refuse("limits", limit.quantity + " needs a bridge of elements (beam_spans); bridge_modes_file has only modes");
}

}  // namespace traverse::scene
