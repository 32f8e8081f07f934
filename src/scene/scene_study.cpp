// Reads the options of sweeps, of the representation of the bridge by modes, and of a screen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double most_speeds = 1e5;
constexpr double speed_tolerance = 1e-3;  // relative to a step: speeds in m/s are often rounded values in km/h

constexpr double slowest = 1.0;  // m/s

}  // namespace

std::vector<double> read_speeds(const Options& o, std::string_view name) {
  const std::vector<double> range = o.numbers(name);
  const double from = range[0], to = range[1], step = range[2];
  if (to < from) o.refuse(name, "from is above to; allowed: from, to, step");
  const double steps = std::floor((to - from) / step + speed_tolerance);
  if (to > from && steps < 1.0)
    o.refuse(name, fmt::format("the step of {:g} m/s is larger than the range from {:g} to {:g} m/s; allowed: "
                               "from, to, step",
                               step, from, to));
  o.check_at_most(name, steps, most_speeds, "speeds");
  return speeds_between(from, to, step);
}

std::vector<double> speeds_between(double from, double to, double step) {
  const double steps = std::floor((to - from) / step + speed_tolerance);
  std::vector<double> speeds;
  for (int i = 0; i <= static_cast<int>(steps); ++i) speeds.push_back(from + i * step);
  return speeds;
}

void read_sweep(const Options& o, Scene& scene) {
  if (!o.has("sweep_speed") && !o.has("sweep_hslm_a")) return;
  scene.sweep.emplace();
  scene.sweep->lanes = static_cast<std::size_t>(std::stoul(o.choice("sweep_lanes")));
  scene.sweep->instants = o.number("sweep_instants");
  if (o.has("sweep_speed")) scene.sweep->speeds = read_speeds(o, "sweep_speed");
  if (o.has("sweep_refine")) {
    scene.sweep->refine = o.number("sweep_refine");
    if (scene.sweep->refine > 0.0 && scene.sweep->speeds.size() < fewest_to_refine)
      o.refuse("sweep_refine",
               fmt::format("sweep_speed gives {} speeds; allowed: at least {}, between which others are added",
                           scene.sweep->speeds.size(), fewest_to_refine));
  }
  if (!o.has("sweep_hslm_a")) return;
  scene.sweep->trains = o.integers("sweep_hslm_a");
}

void read_modal(const Options& o, Scene& scene) {
  if (scene.beam && scene.beam->given) return read_modes_of_given(o, scene);
  const std::string value = o.text("model_modes");
  const int modes = static_cast<int>(o.optional_number("model_modes").value_or(0.0));
  if (modes == 0) {
    scene.modes_open =
        value == "auto" && !(scene.beam && (scene.beam->foundation.nonlinear() || scene.beam->strained()));
    if (o.has("model_damping_ratios")) o.refuse("model_damping_ratios", "needs model_modes");
    return;
  }
  if (scene.analysis != Analysis::transient) {
    scene.notes.emplace_back("model_modes has no effect: it is for transient runs");
    return;
  }
  if (!scene.beam) o.refuse("model_modes", "needs a beam (beam_spans)");
  if (scene.vehicles.empty() && scene.load.forces.empty())
    o.refuse("model_modes", "needs vehicles (train_vehicles) or moving forces (load_forces, load_hslm_a, ...)");
  if (scene.beam->track)
    o.refuse("model_modes", "a bridge under a layered track (track_rail_EI) needs elements; allowed: auto or 0");
  if (scene.beam->foundation.nonlinear())
    o.refuse("model_modes", "the foundation is one-sided, slides, has a gap or a cubic term; allowed: auto or 0");
  if (scene.beam->strained()) o.refuse("model_modes", "temperature or settlements bend the beam; allowed: auto or 0");
  if (const options::Entry* type = o.entries().find("ts_type");
      scene.vehicles.empty() && type != nullptr && type->value != "modal")
    o.refuse("ts_type", "with model_modes and forces alone the motion is exact in time; allowed: modal, or no ts_type");
  scene.model.modes = modes;
  if (scene.model.window_tolerance > 0.0)
    scene.notes.emplace_back("model_window has no effect: with modes the bridge has no parts that could be excluded");
  if (!o.has("model_damping_ratios")) return;
  (void)o.numbers("model_damping_ratios", static_cast<std::size_t>(modes), "one per mode");
  scene.damping_of_modes = o.numbers("model_damping_ratios");
}

void read_screen(const Options& o, Scene& scene) {
  if (scene.analysis != Analysis::screen) return;
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
