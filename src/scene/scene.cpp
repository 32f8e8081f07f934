#include "traverse/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "limits.hpp"
#include "options/read_verdict_limits.hpp"
#include "scene_parts.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

using options::Options;

constexpr std::size_t most_default_probes = 200;
constexpr double most_even_probes = 1e5;
constexpr double one_station = 1e-9;        // m: stations nearer than that are one
constexpr double nearly_one = 1.0 - 1e-12;  // of the parts of a span

constexpr double most_left_out = 0.1;

// What is left out of the steps: -1 where the run decides.
double read_window(const Options& o) {
  const std::string value = o.text("model_window");
  if (value == "auto") return -1.0;
  char* end = nullptr;
  const double part = std::strtod(value.c_str(), &end);
  if (value.empty() || *end != 0 || !(part >= 0.0 && part <= most_left_out))
    o.refuse("model_window",
             fmt::format("allowed: auto, 0, or a part of the largest motion up to {:g}", most_left_out));
  return part;
}

void read_run(const Options& o, Scene& scene) {
  scene.gravity = o.number("gravity");
  scene.name = o.has("scene_name") ? o.text("scene_name") : "scene";
  scene.analysis = options::analysis_of(o.choice("scene_analysis"));
  scene.start = o.choice("scene_start") == "given" ? Start::given : Start::equilibrium;
  scene.tail = o.optional_number("scene_tail");
  scene.end_time = o.optional_number("ts_max_time");
  scene.time_step = o.optional_number("ts_dt");
  scene.step_open = !scene.time_step;
  scene.mode_count = o.integer("modes_count");
  scene.contact_tolerance = o.optional_number("contact_tolerance");
  scene.impact_steps = o.integer("contact_impact_steps");
  scene.step_kinks = o.flag("step_kinks");
  scene.step_probes = o.flag("step_probes");
  scene.step_lanes = o.flag("step_lanes");
  scene.all_ranks = o.choice("step_ranks") == "all";
  scene.rest_tolerance = read_window(o);
  const std::string vehicles = o.choice("model_vehicles");
  scene.vehicle_model = vehicles == "linear" ? VehicleModel::linear
                        : vehicles == "auto" ? VehicleModel::automatic
                                             : VehicleModel::full;
  scene.accuracy = o.number("accuracy");
  if (o.has("accuracy_of")) scene.accuracy_of = o.texts("accuracy_of");
  scene.accuracy_report = o.flag("accuracy_report");
  scene.accuracy_cache = o.flag("accuracy_cache");
}

/// Evenly in every span, both ends included.
void add_even_probes(const Options& o, const std::vector<double>& spans, std::vector<double>& probes) {
  const double spacing = o.number("output_probes_spacing");
  double count = 1.0, left = 0.0;
  for (const double span : spans) count += std::ceil(span / spacing * nearly_one);
  if (count > most_even_probes)
    o.refuse("output_probes_spacing", fmt::format("{:.3g} stations; allowed: at most {:g}", count, most_even_probes));
  for (const double span : spans) {
    const double parts = std::ceil(span / spacing * nearly_one);
    for (double i = left == 0.0 ? 0.0 : 1.0; i <= parts; ++i) probes.push_back(left + span * i / parts);
    left += span;
  }
  probes.back() = left;
}

void read_probes(const Options& o, Scene& scene) {
  const bool named = o.has("output_probes"), even = o.has("output_probes_spacing");
  if (!scene.beam) {
    if (named || even)
      o.refuse(named ? "output_probes" : "output_probes_spacing", "there is no beam to probe (beam_spans)");
    return;
  }
  const std::vector<double>& spans = scene.beam->spans;
  std::vector<double>& probes = scene.output.probes;
  double length = 0.0;
  for (const double span : spans) {
    if (!named && !even && probes.size() < most_default_probes) probes.push_back(length + 0.5 * span);
    length += span;
  }
  if (!named && !even && spans.size() > most_default_probes)
    scene.notes.push_back(
        fmt::format("probes: the middle of the first {} of {} spans", most_default_probes, spans.size()));
  if (named) probes = o.numbers("output_probes");
  for (double& x : probes) {
    if (x > length * (1.0 + 1e-12))
      o.refuse("output_probes", fmt::format("{:g} lies beyond the beam; allowed: from 0 to {:g} m", x, length));
    x = std::min(x, length);
  }
  if (!even) return;
  add_even_probes(o, spans, probes);
  std::sort(probes.begin(), probes.end());
  const auto same = [](double a, double b) { return b - a < one_station; };
  probes.erase(std::unique(probes.begin(), probes.end(), same), probes.end());
}

constexpr double most_frequency = 1e6;  // Hz

// The frequency up to which accelerations count: none where the run decides, 0 where they are not filtered.
std::optional<double> read_low_pass(const Options& o) {
  const std::string value = o.text("output_lowpass");
  if (value == "auto") return {};
  if (value == "none") return 0.0;
  char* end = nullptr;
  const double frequency = std::strtod(value.c_str(), &end);
  if (value.empty() || *end != 0 || !(frequency > 0.0 && frequency <= most_frequency))
    o.refuse("output_lowpass",
             fmt::format("allowed: auto, none, or a frequency above 0 and up to {:g} (Hz)", most_frequency));
  return frequency;
}

void read_filter(const Options& o, Scene& scene) {
  scene.output.low_pass = read_low_pass(o);
  scene.output.low_passed_series = o.flag("output_lowpass_series");
  scene.output.low_pass_asked = o.has("output_lowpass") || scene.output.low_passed_series;
  for (const char* name : {"output_lowpass", "output_lowpass_series"})
    if (o.has(name) && (!scene.beam || scene.analysis != Analysis::transient))
      scene.notes.push_back(std::string(name) + " has no effect: it is for transient runs over a bridge");
  if (scene.output.low_passed_series && scene.sweep)
    scene.notes.emplace_back("output_lowpass_series has no effect: sweeps store no series");
}

void read_limits(const Options& o, Scene& scene) {
  if (!o.has("limits")) return;
  scene.limits = options::read_verdict_limits(o.path("limits"));
  if (scene.analysis == Analysis::transient) return;
  if (scene.analysis == Analysis::static_envelope || scene.analysis == Analysis::rail_forces) {
    const auto finder = scene.analysis == Analysis::rail_forces ? options::LimitFinder::rail : options::LimitFinder::norm;
    std::erase_if(scene.limits,
                  [&](const auto& limit) { return options::limit_quantity(limit.quantity)->finder != finder; });
    return;
  }
  scene.limits.clear();
  scene.notes.emplace_back("limits has no effect: transient runs are checked against limits");
}

void read_wheel_filter(const Options& o, Scene& scene) {
  scene.output.wheel_low_pass = o.number("output_wheel_lowpass");
  scene.output.wheels_filtered = o.has("output_wheel_lowpass") || o.has("output_unloading_level");
  scene.output.unloading_level = o.number("output_unloading_level");
  if (scene.output.wheels_filtered && (scene.vehicles.empty() || scene.analysis != Analysis::transient))
    scene.notes.emplace_back("output_wheel_lowpass has no effect: it is for transient runs with vehicles");
  if (scene.output.wheels_filtered && scene.sweep && scene.limits.empty())
    scene.notes.emplace_back("output_wheel_lowpass has no effect: in sweeps and studies it is for limits");
}

void read_passages(const Options& o, Scene& scene) {
  if (!o.has("output_passages")) return;
  const std::vector<double> places = o.numbers("output_passages");
  if (scene.analysis != Analysis::transient || wheels_at_start(scene).empty() || scene.sweep || asks_for_study(o)) {
    scene.notes.emplace_back("output_passages has no effect: it is for a single transient run of vehicles with wheels");
    return;
  }
  if (scene.train.drive != Drive::constant || !(scene.train.speed > 0.0))
    o.refuse("output_passages", "needs a train that runs at a prescribed speed above 0; allowed: train_drive constant");
  scene.output.passages = places;
}

bool has_control_character(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; });
}

/// The name is a part of a file's name, which stays in the folder of results.
void check_name(const Options& o, const std::string& name) {
  if (name.find('/') != std::string::npos || name == "." || name == ".." || has_control_character(name))
    o.refuse("scene_name", "allowed: a name without / and line breaks; -output_file takes a path");
}

void read_output(const Options& o, Scene& scene) {
  check_name(o, scene.name);
  if (o.has("output_file") && has_control_character(o.text("output_file")))
    o.refuse("output_file", "allowed: a path without line breaks and other control characters");
  scene.output.file = o.has("output_file") ? o.text("output_file") : "results/" + scene.name + ".h5";
  if (scene.output.file == "none") scene.output.file.clear();
  scene.output.interval = o.optional_number("output_interval");
  scene.quiet = o.flag("output_quiet");
  scene.check = o.flag("check");
  read_probes(o, scene);
  read_filter(o, scene);
  read_limits(o, scene);
  read_wheel_filter(o, scene);
  read_passages(o, scene);
}

/// A run ends when the last wheel or force has left the beam, or when the user says.
void check_end(const Options& o, const Scene& scene) {
  if (scene.analysis != Analysis::transient || scene.end_time) return;
  const auto rolls = [](const Vehicle& v) { return !v.wheels.empty(); };
  const bool wheels = std::any_of(scene.vehicles.begin(), scene.vehicles.end(), rolls);
  const bool forces = !scene.load.forces.empty();
  const bool leaves =
      scene.beam && (!wheels || scene.train.speed > 0.0) && (!forces || scene.load.speed > 0.0) && (wheels || forces);
  if (leaves || (scene.beam && scene.tail)) return;
  std::string why = "nothing leaves a bridge in this scene, so its end has to be given (s)";
  if (wheels && scene.train.speed == 0.0) why = "train_speed is 0: the train never leaves; give the end of the run (s)";
  if (forces && scene.load.speed == 0.0) why = "load_speed is 0: the forces never leave; give the end of the run (s)";
  o.refuse("ts_max_time", why);
}

void check_scene(const Options& o, Scene& scene) {
  if (!scene.beam && scene.vehicles.empty()) {
    throw InputError("nothing to simulate: neither a beam (beam_spans) nor vehicles (train_vehicles) are given");
  }
  if (scene.analysis == Analysis::modes && !scene.beam) o.refuse("scene_analysis", "modes need a beam (beam_spans)");
  if (scene.vehicles.empty()) {
    for (const char* name : {"train_positions", "train_spacing", "train_drive"}) {
      if (o.has(name)) scene.notes.push_back(std::string(name) + " has no effect: there are no train_vehicles");
    }
  }
  if (scene.load.forces.empty()) {
    for (const char* name : {"load_positions", "load_speed"}) {
      if (o.has(name)) scene.notes.push_back(std::string(name) + " has no effect: there are no load_forces");
    }
  }
  check_end(o, scene);
}

}  // namespace

double greatest_speed(const Scene& scene) {
  return std::max(scene.train.vehicles.empty() ? 0.0 : scene.train.speed,
                  scene.load.forces.empty() ? 0.0 : scene.load.speed);
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

Scene read_scene(Options o) {
  if (asks_for_study(o)) return read_study(o);
  Scene scene;
  declare_blocks(o);
  const NamedVehicles vehicles = declare_vehicles(o);
  declare_couplers(o);
  declare_stretches(o);
  o.check_names();
  o.check_values();
  read_run(o, scene);
  read_beam(o, scene);
  read_sweep(o, scene);
  read_trains(o, vehicles, scene);
  read_load(o, scene);
  read_track(o, scene);
  read_layers(o, scene);
  read_output_sleepers(o, scene);
  check_courses(o, scene);
  decide_axial(o, scene);
  read_output(o, scene);
  read_modal(o, scene);
  read_damping_bound(o, scene);
  read_norm(o, scene);
  read_rail_loads(o, scene);
  check_scene(o, scene);
  if (const options::Entry* study = o.first_with_prefix("study_"))
    scene.notes.push_back(study->name + " has no effect: study_vary names no option to vary");
  check_sense(o, vehicles, scene);
  check_size(o, scene);
  scene.options = o.all();
  return scene;
}

Scene read_scene() { return read_scene(Options(options::in_force())); }

}  // namespace traverse::app
