// Reads the options of a screen.
#include <fmt/format.h>

#include "scene_parts.hpp"

namespace traverse::scene {

using options::Options;

namespace {

constexpr double slowest = 1.0;  // m/s

}  // namespace

void read_screen(const Options& o, Scene& scene) {
  if (scene.analysis != Analysis::screen) {
    if (const options::Entry* entry = o.first_with_prefix("screen_"))
      scene.notes.push_back(entry->name + " has no effect: it belongs to scene_analysis screen");
    return;
  }
  if (scene.beam || !scene.vehicles.empty() || !scene.load.forces.empty())
    o.refuse("scene_analysis",
             "screen takes its bridges and trains from screen_stock and screen_fleet; allowed: no beam_, train_ and "
             "load_ options");
  for (const char* name : {"screen_stock", "screen_fleet", "limits"})
    if (!o.has(name)) o.refuse("scene_analysis", fmt::format("screen needs {}", name));
  if (scene.limits.empty())
    o.refuse("limits", "a screen computes deck_acceleration and deflection_over_span; the file has neither of them");
  options::Screen screen;
  screen.stock = o.path("screen_stock");
  screen.fleet = o.path_or_folder("screen_fleet");
  constexpr double kmh = 1.0 / 3.6;
  screen.speeds =
      o.has("screen_speeds") ? read_speeds(o, "screen_speeds") : speeds_between(10.0 * kmh, 250.0 * kmh, kmh);
  if (screen.speeds.front() < slowest)
    o.refuse("screen_speeds", fmt::format("from {:g} m/s; allowed: from {:g} m/s on", screen.speeds.front(), slowest));
  screen.modes = o.integer("screen_modes");
  screen.parts = o.integer("screen_stations");
  screen.samples = o.number("screen_samples");
  screen.audit = o.integer("screen_audit");
  screen.resume = o.flag("screen_resume");
  if (o.has("screen_pair")) {
    screen.pair = o.texts("screen_pair");
    if (screen.pair.size() != 2 && screen.pair.size() != 3)
      o.refuse("screen_pair", "allowed: a bridge, a formation, and optionally an options file of the train");
  }
  scene.screen = screen;
}

}  // namespace traverse::scene
