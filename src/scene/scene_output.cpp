// Reads the options of the results: file, stations, filters and places on the track.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr std::size_t most_default_probes = 200;
constexpr int parts_of_a_span = 10;
constexpr double most_even_probes = 1e5;
constexpr double same_station = 1e-9;       // m: stations closer than this are the same
constexpr double nearly_one = 1.0 - 1e-12;  // factor against rounding errors of the number of parts of a span

/// Adds evenly spaced probes in each span, with both ends.
void add_even_probes(const Options& o, const std::vector<double>& spans, std::vector<double>& probes) {
  const double spacing = o.number("output_probes_spacing");
  double count = 1.0, left = 0.0;
  for (const double span : spans) count += std::ceil(span / spacing * nearly_one);
  o.check_at_most("output_probes_spacing", count, most_even_probes, "stations");
  for (const double span : spans) {
    const double parts = std::ceil(span / spacing * nearly_one);
    for (double i = left == 0.0 ? 0.0 : 1.0; i <= parts; ++i) probes.push_back(left + span * i / parts);
    left += span;
  }
  probes.back() = left;
}

/// Whether a limit applies to the largest response of the deck at any station.
bool limits_largest_deck_response(const Scene& scene) {
  static constexpr std::array quantities = {"deck_acceleration", "unfiltered_deck_acceleration",
                                            "deflection_over_span"};
  return std::any_of(scene.limits.begin(), scene.limits.end(), [](const options::VerdictLimit& limit) {
    return std::find(quantities.begin(), quantities.end(), limit.quantity) != quantities.end();
  });
}

/// Adds evenly spaced probes in each span for limits of the largest response of the deck.
void add_probes_for_limits(Scene& scene) {
  const std::vector<double>& spans = scene.beam->spans;
  std::vector<double>& probes = scene.output.probes;
  const int parts = std::min(static_cast<int>(most_default_probes / spans.size()), parts_of_a_span);
  if (parts < 2 || !limits_largest_deck_response(scene)) return;
  double left = 0.0;
  for (const double span : spans) {
    for (int i = 1; i < parts; ++i) {
      const double x = left + span * i / parts;
      if (std::none_of(probes.begin(), probes.end(), [x](double p) { return std::abs(p - x) < same_station; }))
        probes.push_back(x);
    }
    left += span;
  }
  scene.notes.push_back(fmt::format(
      "probes: limits apply to the largest response of the deck, so there are further probes at every 1/{} of "
      "a span; output_probes_spacing changes this",
      parts));
}

void read_probes(const Options& o, Scene& scene) {
  const bool named = o.has("output_probes"), even = o.has("output_probes_spacing");
  if (!scene.beam) return;
  const std::vector<double>& spans = scene.beam->spans;
  std::vector<double>& probes = scene.output.probes;
  const std::size_t most = scene.output.series ? most_default_probes : spans.size();
  double length = 0.0;
  for (const double span : spans) {
    if (!named && !even && probes.size() < most) probes.push_back(length + 0.5 * span);
    length += span;
  }
  if (!named && !even && spans.size() > most)
    scene.notes.push_back(fmt::format("probes: the middle of the first {} of {} spans", most, spans.size()));
  if (named) probes = o.numbers("output_probes");
  for (double& x : probes) x = place_on_beam(o, "output_probes", x, length);
  if (!even) return add_probes_for_limits(scene);
  add_even_probes(o, spans, probes);
  std::sort(probes.begin(), probes.end());
  const auto same = [](double a, double b) { return b - a < same_station; };
  probes.erase(std::unique(probes.begin(), probes.end(), same), probes.end());
}

/// Each track with a name has probes of its own at the same stations.
void repeat_probes_for_tracks(Scene& scene) {
  const std::vector<double> stations = std::exchange(scene.output.probes, {});
  for (const Track& track : scene.tracks) {
    scene.output.probes.insert(scene.output.probes.end(), stations.begin(), stations.end());
    scene.output.eccentricities.resize(scene.output.probes.size(), track.line.lever);
  }
}

constexpr const char* low_passed_peak = "acceleration_lowpass";  // in accuracy_of

void read_filter(const Options& o, Scene& scene) {
  scene.output.low_pass = o.optional_number("output_lowpass");
  if (o.text("output_lowpass") == "none") scene.output.low_pass = 0.0;
  scene.output.low_passed_series = o.flag("output_lowpass_series");
  const std::vector<std::string>& estimated = scene.accuracy_of;
  const bool named = std::find(estimated.begin(), estimated.end(), low_passed_peak) != estimated.end();
  if (named && scene.output.low_pass == 0.0)
    o.refuse("accuracy_of",
             fmt::format("{} needs a filter, but output_lowpass is none; remove one of the two", low_passed_peak));
  scene.output.low_pass_requested = o.has("output_lowpass") || scene.output.low_passed_series || named;
  for (const char* name : {"output_lowpass", "output_lowpass_series"})
    if (o.has(name) && (!scene.beam || scene.analysis != Analysis::transient))
      scene.notes.push_back(std::string(name) + " has no effect: it is for transient runs over a bridge");
  if (scene.output.low_passed_series && scene.sweep)
    scene.notes.emplace_back("output_lowpass_series has no effect: sweeps store no series");
  if (scene.sweep) drop_peaks_without_estimate(scene);
}

void read_wheel_filter(const Options& o, Scene& scene) {
  scene.output.wheel_low_pass = o.number("output_wheel_lowpass");
  scene.output.wheels_filtered = o.has("output_wheel_lowpass") || o.has("output_unloading_level");
  scene.output.unloading_level = o.number("output_unloading_level");
  if (scene.output.wheels_filtered && (scene.vehicles.empty() || scene.analysis != Analysis::transient))
    scene.notes.emplace_back("output_wheel_lowpass has no effect: it is for transient runs with vehicles");
  if (scene.output.wheels_filtered && scene.sweep && scene.limits.empty())
    scene.notes.emplace_back("output_wheel_lowpass has no effect: in sweeps and studies it is only for limits");
}

void read_passages(const Options& o, Scene& scene) {
  if (!o.has("output_passages")) return;
  const std::vector<double> places = o.numbers("output_passages");
  if (scene.analysis != Analysis::transient || wheels_at_start(scene).empty() || scene.sweep || describes_study(o)) {
    scene.notes.emplace_back("output_passages has no effect: it is for a single transient run of vehicles with wheels");
    return;
  }
  if (scene.train.drive != Drive::constant || !(scene.train.speed > 0.0))
    o.refuse("output_passages", "needs a train that runs at a prescribed speed above 0; allowed: train_drive constant");
  scene.output.passages = places;
}

/// Whether an option of stations on a layered track has an effect; otherwise a note says so.
bool stores_track(const Options& o, const char* option, Scene& scene) {
  if (!o.has(option)) return false;
  const bool runs = scene.analysis == Analysis::transient || scene.analysis == Analysis::static_response;
  if (runs && !scene.sweep && !describes_study(o) && scene.output.series) return true;
  scene.notes.push_back(fmt::format("{} has no effect: it is for a single transient or static run{}", option,
                                    scene.output.series ? "" : " with output_series"));
  return false;
}

void read_rail_stations(const Options& o, Scene& scene) {
  if (!stores_track(o, "output_rail", scene)) return;
  const beam::RailMesh rail = beam::rail_mesh(*scene.beam);
  scene.output.rail = o.numbers("output_rail");
  for (const double x : scene.output.rail)
    if (!(x >= rail.start && x <= rail.x(rail.elements)))
      o.refuse("output_rail", fmt::format("there is no track at x = {:g} m; allowed: from {:g} to {:g} m", x,
                                          rail.start, rail.x(rail.elements)));
}

void read_sleepers(const Options& o, Scene& scene) {
  if (!stores_track(o, "output_sleepers", scene)) return;
  const beam::LayeredTrack& track = *scene.beam->track;
  const beam::RailMesh rail = beam::rail_mesh(*scene.beam);
  const int last = rail.elements / track.elements_per_bay;
  std::vector<double>& chosen = scene.output.sleepers;
  for (const double x : o.numbers("output_sleepers")) {
    const double bay = std::round((x - rail.start) / track.spacing);
    if (!(bay >= 0.0 && bay <= last))
      o.refuse("output_sleepers", fmt::format("there is no track at x = {:g} m; allowed: from {:g} to {:g} m", x,
                                              rail.start, rail.x(rail.elements)));
    const double station = rail.x(static_cast<int>(bay) * track.elements_per_bay);
    if (!track.has_sleeper(station))
      o.refuse("output_sleepers", fmt::format("the sleeper at x = {:g} m is missing (track_stretches)", station));
    if (std::find(chosen.begin(), chosen.end(), station) != chosen.end())
      o.refuse("output_sleepers",
               fmt::format("names the sleeper at x = {:g} m twice; allowed: each sleeper once", station));
    chosen.push_back(station);
  }
}

void read_surfaces(const Options& o, Scene& scene) {
  const bool of_wheels =
      scene.analysis == Analysis::transient && !scene.sweep && !describes_study(o) && !wheels_at_start(scene).empty();
  if (o.flag("output_contact_points")) {
    scene.output.contact_points = of_wheels && scene.output.series;
    if (!scene.output.contact_points)
      scene.notes.emplace_back(
          "output_contact_points has no effect: it is for a single transient run of vehicles with wheels and with "
          "output_series");
  }
  if (!o.has("output_profile") || o.text("output_profile") == "none") return;
  if (!of_wheels) {
    scene.notes.emplace_back("output_profile has no effect: it is for a single transient run of vehicles with wheels");
    return;
  }
  scene.output.profile = o.optional_number("output_profile");
  const auto own_surface = [](const train::Course& course) { return course.profile && !course.profile->level(); };
  if (scene.profile.level() && std::ranges::none_of(scene.train.courses, own_surface))
    scene.notes.emplace_back("output_profile has no effect: the track is level (track_profile)");
}

bool has_control_character(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; });
}

/// Checks the name of the scene. It is part of a file name, so that the file remains in the folder of results.
void check_name(const Options& o, const std::string& name) {
  if (name.find('/') != std::string::npos || name == "." || name == ".." || has_control_character(name))
    o.refuse("scene_name", "allowed: a name without / and line breaks; use -output_file for a path");
}

/// Checks the ending of a file name that a file of options gives. Such a file may come from another person, and no
/// shell or desktop executes a file with these endings. The command line, which the user writes, may give any name.
void check_ending(const Options& o, const std::string& name, const std::string& ending) {
  const options::Entry* entry = o.entries().find(name);
  if (entry == nullptr || !entry->from_file() || entry->value == "none" || o.text(name).ends_with(ending)) return;
  o.refuse(name, "allowed in an options file: a name that ends in " + ending + "; the command line may give any name");
}

}  // namespace

void drop_peaks_without_estimate(Scene& scene) {
  scene.output.low_pass_requested = false;
  const auto drop = [&](const char* name, const char* why) {
    if (std::erase(scene.accuracy_of, name) == 0) return;
    scene.notes.push_back(
        fmt::format("accuracy_of {}: its error is not estimated: the runs of sweeps and studies {}{}", name, why,
                    scene.accuracy_of.empty() ? "; the errors of all other peaks are estimated instead" : ""));
  };
  if (!scene.limits_deck_acceleration())
    drop(low_passed_peak, "low-pass deck accelerations only if limits need deck_acceleration");
  for (const char* name : {"shear", "axial_displacement", "axial_force"}) drop(name, "do not evaluate its peaks");
}

void read_output(const Options& o, Scene& scene) {
  check_name(o, scene.name);
  if (o.has("output_file") && has_control_character(o.text("output_file")))
    o.refuse("output_file", "allowed: a path without line breaks and other control characters");
  for (const auto& [name, ending] : {std::pair("output_file", ".h5"), std::pair("checkpoint_file", ".checkpoint")})
    check_ending(o, name, ending);
  scene.output.file = o.has("output_file") ? o.text("output_file") : "results/" + scene.name + ".h5";
  if (scene.output.file == "none") scene.output.file.clear();
  scene.output.interval = o.optional_number("output_interval");
  scene.output.series = o.flag("output_series");
  scene.quiet = o.flag("output_quiet");
  scene.verbose = o.flag("verbose");
  scene.describe = o.flag("describe");
  read_probes(o, scene);
  if (!scene.tracks.empty()) repeat_probes_for_tracks(scene);
  read_filter(o, scene);
  read_wheel_filter(o, scene);
  read_passages(o, scene);
  read_rail_stations(o, scene);
  read_sleepers(o, scene);
  read_surfaces(o, scene);
}

}  // namespace traverse::scene
