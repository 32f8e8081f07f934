// Reads the profile of the running surface: bump, table, roughness and dips.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scene_parts.hpp"
#include "track/spectrum_names.hpp"

namespace traverse::scene {
namespace {

using options::Options;

Roughness read_roughness(const Options& o, const std::string& prefix, const track::Spectrum& spectrum, double start,
                         bool to_the_left) {
  std::vector<double> wavelengths = {spectrum.shortest, spectrum.longest};
  if (const std::string option = prefix + "_wavelengths"; o.has(option)) {
    wavelengths = o.numbers(option);
    if (!(wavelengths[0] < wavelengths[1])) o.refuse(option, "allowed: the shortest, then the longest wavelength");
  }
  return {spectrum, wavelengths[0], wavelengths[1], start, to_the_left};
}

/// x at which the roughness begins: the foremost wheel of trains to the right or, if all trains run to the left, their
/// foremost wheel, so that the train starts on level track.
double start_of_roughness(const Scene& scene, bool& to_the_left) {
  std::optional<double> right, left;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i) {
    const bool back = train::law_of(scene.train, i).direction() < 0.0;
    for (const double x : wheels_at_start(scene, i))
      if (back)
        left = std::min(x, left.value_or(x));
      else
        right = std::max(x, right.value_or(x));
  }
  to_the_left = left && !right;
  return right ? *right : left.value_or(0.0);
}

/// Adds dips and humps to the profile.
void read_dips(const Options& o, Scene& scene) {
  if (!o.has("track_dips_x")) return;
  const std::vector<double> x = o.numbers("track_dips_x");
  const std::vector<double> length = o.numbers("track_dips_length", x.size(), "one per dip");
  const std::vector<double> depth = o.numbers("track_dips_depth", x.size(), "one per dip");
  const std::vector<std::string> shape = o.texts("track_dips_shape", x.size(), "one per dip");
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (shape[i] == "joint" && depth[i] < 0.0)
      o.refuse("track_dips_depth", "a dip of shape joint has a negative depth; allowed: not below 0");
    const track::Dip dip{x[i], length[i], depth[i], shape[i] == "joint"};
    scene.profile = scene.profile.with(dip);
    if (scene.roughness) scene.roughness->dips.push_back(dip);
  }
}

}  // namespace

ReadProfile read_profile(const Options& o, const std::string& prefix, double start, bool to_the_left, Scene& scene) {
  const auto key = [&](const char* word) { return prefix + "_" + word; };
  const std::string option = key("profile"), profile = o.text(option);
  const bool is_file = o.is_table(option);
  if (!is_file && o.has(key("profile_shape")))
    scene.notes.push_back(key("profile_shape") + " has no effect: " + option + " is " + profile);
  const options::Entry* bump = o.first_with_prefix(key("bump"));
  if (profile == "bump")
    return {
        track::Profile::bump(o.number(key("bump_start")), o.number(key("bump_length")), o.number(key("bump_height"))),
        {}};
  if (bump != nullptr) scene.notes.push_back(bump->name + " has no effect: " + option + " is " + profile);
  const std::optional<track::Spectrum> spectrum = track::spectrum_of(profile);
  if (!spectrum && o.has(key("wavelengths")))
    scene.notes.push_back(key("wavelengths") + " has no effect: " + option + " is " + profile);
  if (profile == "none") return {};
  if (spectrum) {
    const Roughness roughness = read_roughness(o, prefix, *spectrum, start, to_the_left);
    return {roughness.profile(static_cast<std::uint64_t>(o.integer(key("seed")))), roughness};
  }
  if (!is_file) {
    o.refuse(option, fmt::format("allowed: none, bump, {}, or a file x,height",
                                 static_cast<std::string_view>(track::names_of_spectra)));
  }
  const auto profile_of = o.text(key("profile_shape")) == "spline" ? track::Profile::spline : track::Profile::lines;
  return {from_table(o, option, profile_columns,
                     [&](auto columns) {
                       return profile_of(std::move(columns[0]), std::move(columns[1]),
                                         fmt::format("{} ({})", option, o.path(option)));
                     }),
          {}};
}

void read_track(const Options& o, Scene& scene) {
  bool to_the_left = false;
  const double start = start_of_roughness(scene, to_the_left);
  // Trains with courses have the profiles of their tracks.
  const bool one_train = scene.train.courses.empty() && !scene.train.vehicles.empty();
  const Track* track = one_train ? track_of_block(o, blocks_of(o, "trains").front(), scene) : nullptr;
  const bool own = track != nullptr && o.has(track->name + "_profile");
  ReadProfile read = read_profile(o, own ? track->name : "track", start, to_the_left, scene);
  scene.profile = std::move(read.profile);
  scene.roughness = read.roughness;
  read_dips(o, scene);
}

}  // namespace traverse::scene
