// Reads the general options of a scene, calls the readers of beam, trains, loads, track and output in order, and checks
// that the scene has a motion and an end.
#include "traverse/scene/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "limits.hpp"
#include "options/read_verdict_limits.hpp"
#include "options/relations.hpp"
#include "scene_parts.hpp"
#include "train/wheel_paths.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"

namespace traverse::scene {
namespace {

using options::Options, options::Related;

void read_run(const Options& o, Scene& scene) {
  scene.gravity = o.number("gravity");
  scene.name = o.has("scene_name") ? o.text("scene_name") : "scene";
  scene.analysis = options::analysis_of(o.choice("scene_analysis"));
  scene.start = o.choice("scene_start") == "given" ? Start::given : Start::equilibrium;
  scene.tail = o.optional_number("scene_tail");
  scene.end_time = o.optional_number("ts_max_time");
  scene.model.step = o.optional_number("ts_dt");
  scene.step_open = !scene.model.step;
  scene.mode_count = o.integer("modes_count");
  scene.contact_tolerance = o.optional_number("contact_tolerance");
  scene.impact_steps = o.integer("contact_impact_steps");
  scene.model.local_compliance = o.flag("contact_seats");
  scene.model.step_kinks = o.flag("step_kinks");
  scene.model.step_probes = o.flag("step_probes");
  scene.all_ranks = o.choice("step_ranks") == "all";
  scene.model.window_tolerance = o.optional_number("model_window").value_or(-1.0);
  const std::string vehicles = o.choice("model_vehicles");
  scene.model.vehicles = vehicles == "linear" ? VehicleModel::linear
                         : vehicles == "auto" ? VehicleModel::automatic
                                              : VehicleModel::full;
  scene.accuracy = o.number("accuracy");
  if (o.has("accuracy_of")) scene.accuracy_of = o.texts("accuracy_of");
  scene.accuracy_report = o.flag("accuracy_report");
  scene.accuracy_cache = o.flag("accuracy_cache");
}

void read_limits(const Options& o, Scene& scene) {
  if (!o.has("limits")) return;
  scene.limits = options::read_verdict_limits(o.path("limits"));
  if (scene.analysis == Analysis::transient) {
    if (scene.sweep && !o.has("sweep_refine") && scene.has_run_limits() &&
        scene.sweep->speeds.size() >= fewest_to_refine)
      scene.sweep->refine = -1.0;
    if (scene.limits_quantity("track_twist"))
      scene.notes.emplace_back(
          "error not estimated: track_twist: trial runs do not compare it; a larger model_modes or "
          "beam_elements_per_span shows it");
    return;
  }
  if (scene.analysis == Analysis::static_envelope || scene.analysis == Analysis::rail_forces) {
    const auto finder =
        scene.analysis == Analysis::rail_forces ? options::LimitFinder::rail : options::LimitFinder::norm;
    std::erase_if(scene.limits,
                  [&](const auto& limit) { return options::limit_quantity(limit.quantity)->finder != finder; });
    return;
  }
  if (scene.analysis == Analysis::screen) {
    std::erase_if(scene.limits, [](const auto& limit) {
      return limit.quantity != "deck_acceleration" && limit.quantity != "deflection_over_span";
    });
    return;
  }
  scene.limits.clear();
  scene.notes.emplace_back("limits has no effect with this scene_analysis");
}

/// x is along the beam and y perpendicular to it, so that a gradient turns the direction of gravity.
void read_gradient(const Options& o, Scene& scene) {
  const double gradient = o.number("track_gradient");
  if (gradient == 0.0) return;
  if (scene.beam && (scene.beam->track || scene.beam->given))
    o.refuse("track_gradient", scene.beam->track ? "allowed without a layered track only"
                                                 : "given modes have no motion along the beam; allowed: 0");
  scene.gravity /= std::hypot(1.0, gradient);
  if (scene.beam) scene.beam->gradient = gradient;
  for (Vehicle& vehicle : scene.vehicles) {
    vehicle.mechanism.gravity = scene.gravity;
    vehicle.mechanism.gradient = gradient;
  }
}

/// Checks that the run has an end: the last wheel or force leaves the beam, or the user gives the end time.
void check_end(const Options& o, const Scene& scene) {
  if (scene.analysis != Analysis::transient || scene.end_time) return;
  const auto rolls = [](const Vehicle& v) { return !v.wheels.empty(); };
  const bool wheels = std::any_of(scene.vehicles.begin(), scene.vehicles.end(), rolls);
  const bool forces = !scene.load.forces.empty();
  const bool leaves =
      scene.beam && (!wheels || scene.train.speed > 0.0) && (!forces || scene.load.speed > 0.0) && (wheels || forces);
  if (leaves || (scene.beam && scene.tail)) return;
  if (!wheels && !forces && scene.beam && scene.vehicles.empty())
    throw InputError(
        "nothing moves over the bridge: neither vehicles (train_vehicles) nor moving forces (load_forces, load_hslm_a, "
        "load_file, ...) are given; a run without them needs an end time (ts_max_time)");
  std::string why = "no wheel or force leaves a bridge in this scene, so the end time must be given (s)";
  if (wheels && scene.train.speed == 0.0) why = "train_speed is 0, so the train never leaves; give the end time (s)";
  if (forces && scene.load.speed == 0.0) why = "load_speed is 0, so the forces never leave; give the end time (s)";
  o.refuse("ts_max_time", why);
}

void check_scene(const Options& o, Scene& scene) {
  if (!scene.beam && scene.vehicles.empty() && !scene.screen) {
    throw InputError("nothing to simulate: neither a beam (beam_spans) nor vehicles (train_vehicles) are given");
  }
  if (scene.sweep && !scene.sweep->speeds.empty() && greatest_speed(scene) == 0.0)
    o.refuse("sweep_speed", "nothing moves, because the speed that is given for it is 0");
  check_end(o, scene);
}

/// Adds a note on the wheels and forces that are on the bridge or its approaches at the start.
void record_start(Scene& scene) {
  if (!scene.beam || scene.analysis != Analysis::transient) return;
  const double approach = scene.beam->track ? scene.beam->track->approach : 0.0, end = scene.beam->length() + approach;
  std::size_t wheels = 0, forces = 0;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i)
    for (const double x : wheels_at_start(scene, i))
      if (train::is_on_line(-approach, end, x, speed_of(scene.train, i, 0.0))) ++wheels;
  for (std::size_t i = 0; i < scene.load.positions.size(); ++i) {
    const double x = scene.load.positions[i], half = 0.5 * length_of(scene.load, i);
    const bool line_load_on = x + half > -approach && x - half < end;
    if (half > 0.0 ? line_load_on : train::is_on_line(-approach, end, x, speed_of(scene.load, i, 0.0))) ++forces;
  }
  std::vector<std::string> standing;
  for (const auto& [count, what] : {std::pair(wheels, "wheel"), std::pair(forces, "force")})
    if (count > 0) standing.push_back(fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"));
  if (standing.empty()) return;
  scene.notes.push_back(fmt::format(
      "on the bridge{} at the start: {}; {}", approach > 0.0 ? " or its approaches" : "", fmt::join(standing, " and "),
      scene.start == Start::equilibrium ? "the run begins in the static equilibrium under them"
                                        : "the bridge begins to deflect under them (scene_start: given)"));
}

}  // namespace

bool has_own_contact_law(const Scene& scene) {
  const auto own = [](const auto& contact) { return contact.law.kind == contact::LawKind::other; };
  return std::ranges::any_of(scene.vehicles, [&](const Vehicle& vehicle) {
    return std::ranges::any_of(vehicle.wheels, own) || std::ranges::any_of(vehicle.contacts, own);
  });
}

double greatest_speed(const Scene& scene) {
  return std::max(scene.train.vehicles.empty() ? 0.0 : scene.train.speed,
                  scene.load.forces.empty() ? 0.0 : scene.load.speed);
}

double moving_speed(const Scene& scene) {
  return !scene.vehicles.empty() && scene.train.speed > 0.0 ? scene.train.speed : scene.load.speed;
}

void set_speed(Scene& scene, double speed) {
  if (scene.train.courses.empty() && scene.train.speed > 0.0) scene.train.speed = speed;
  if (scene.load.courses.empty() && scene.load.speed > 0.0) scene.load.speed = speed;
}

double shortest_wave(const Scene& scene) {
  double wave = scene.profile.shortest_wave();
  for (const train::Course& course : scene.train.courses)
    if (course.profile) wave = std::min(wave, course.profile->shortest_wave());
  for (const int index : scene.train.vehicles)
    for (const Wheel& wheel : scene.vehicles[static_cast<std::size_t>(index)].wheels) {
      if (wheel.shape.flat_length > 0.0) wave = std::min(wave, wheel.shape.flat_length);
      if (wheel.shape.polygon_amplitude > 0.0)
        wave = std::min(wave, 2.0 * std::numbers::pi * wheel.radius / wheel.shape.polygon_order);
    }
  return wave;
}

std::vector<double> wheels_at_start(const Scene& scene, std::size_t i) {
  const Vehicle& vehicle = scene.vehicles[static_cast<std::size_t>(scene.train.vehicles[i])];
  std::vector<double> x;
  for (const Wheel& wheel : vehicle.wheels)
    x.push_back(scene.train.positions[i] + vehicle.mechanism.bodies[static_cast<std::size_t>(wheel.body)].position.x());
  return x;
}

std::vector<double> wheels_at_start(const Scene& scene) {
  std::vector<double> all;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i)
    for (const double x : wheels_at_start(scene, i)) all.push_back(x);
  return all;
}

NamedVehicles declare_parts(Options& o) {
  declare_blocks(o);
  NamedVehicles vehicles = declare_vehicles(o);
  declare_couplers(o);
  declare_stretches(o);
  declare_dampers(o);
  return vehicles;
}

void check_options(const Options& o) {
  o.check_names();
  o.check_values();
  check_relations(o, Related::study);
}

namespace {

/// Checks the relations between the options of one run, and adds a note on each option without effect.
void check_scene_options(const Options& o, std::vector<std::string>& notes) {
  const auto check = [&](Related related, const std::string& block) {
    for (std::string& note : check_relations(o, related, block)) notes.push_back(std::move(note));
  };
  check(Related::scene, "");
  for (const char* list : {"trains", "loads"})
    for (const Block& block : blocks_of(o, list)) check(Related::course, block.option(""));
  for (const Block& block : blocks_of(o, "loads")) check(Related::load, block.option(""));
}

/// A scene that is neither a study nor a fit.
Scene read_one_scene(Options o) {
  Scene scene;
  const NamedVehicles vehicles = declare_parts(o);
  check_options(o);
  check_scene_options(o, scene.notes);
  read_run(o, scene);
  read_beam(o, scene);
  read_sweep(o, scene);
  read_trains(o, vehicles, scene);
  read_load(o, scene);
  read_track(o, scene);
  read_layers(o, scene);
  check_courses(o, scene);
  read_gradient(o, scene);
  decide_axial(o, scene);
  read_limits(o, scene);
  read_output(o, scene);
  read_modal(o, scene);
  read_support_motion(o, scene);
  read_damping_bound(o, scene);
  read_norm(o, scene);
  read_rail_loads(o, scene);
  read_screen(o, scene);
  check_scene(o, scene);
  scene.notes.insert(scene.notes.end(), o.notes().begin(), o.notes().end());
  check_plausibility(o, vehicles, scene);
  record_start(scene);
  check_size(o, scene);
  scene.options = o.all();
  return scene;
}

}  // namespace

Scene read_scene(Options o) {
  if (describes_study(o) && describes_fit(o))
    o.refuse(o.first_with_prefix("fit_")->name, "a scene is either a study or a fit; remove study_vary or fit_vary");
  const auto given = std::make_shared<const options::Entries>(o.entries());
  Scene scene = describes_study(o) ? read_study(o) : describes_fit(o) ? read_fit(o) : read_one_scene(std::move(o));
  scene.given = given;
  return scene;
}

Scene read_scene() {
  Scene scene = read_scene(Options(options::in_force()));
  const std::vector<std::string>& notes = options::notes_on_input();
  scene.notes.insert(scene.notes.begin(), notes.begin(), notes.end());
  return scene;
}

}  // namespace traverse::scene
