// track of a scene: the running surface's profile.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "options/data_file.hpp"
#include "scene_parts.hpp"

namespace traverse::app {
namespace {

using options::Options;

std::optional<track::Spectrum> spectrum_of(const std::string& profile) {
  const auto grade = [&](std::string_view kind, char first, char last) {
    return profile.size() == kind.size() + 1 && profile.starts_with(kind) && profile.back() >= first &&
           profile.back() <= last;
  };
  if (grade("iso8608_", 'A', 'E')) return track::iso8608(profile.back());
  if (grade("fra_", '1', '6')) return track::fra(profile.back() - '0');
  if (profile == "german_low" || profile == "german_high") return track::german(profile == "german_high");
  return {};
}

Roughness rough(const Options& o, const Scene& scene, const track::Spectrum& spectrum) {
  std::vector<double> wavelengths = {spectrum.shortest, spectrum.longest};
  if (o.has("track_wavelengths")) {
    wavelengths = o.numbers("track_wavelengths");
    if (!(wavelengths[0] < wavelengths[1])) o.refuse("track_wavelengths", "allowed: the shortest, then the longest");
  }
  const std::vector<double> wheels = wheels_at_start(scene);
  // From the foremost wheel on, so that the train starts on level track.
  const double start = wheels.empty() ? 0.0 : *std::max_element(wheels.begin(), wheels.end());
  return {spectrum, wavelengths[0], wavelengths[1], start};
}

void read_profile(const Options& o, Scene& scene) {
  const std::string profile = o.text("track_profile");
  const options::Entry* bump = o.first_with_prefix("track_bump");
  if (profile == "bump") {
    scene.profile = track::Profile::bump(o.number("track_bump_start"), o.number("track_bump_length"),
                                         o.number("track_bump_height"));
    return;
  }
  if (bump != nullptr) scene.notes.push_back(bump->name + " has no effect: track_profile is " + profile);
  const std::optional<track::Spectrum> spectrum = spectrum_of(profile);
  if (!spectrum && o.has("track_wavelengths"))
    scene.notes.push_back("track_wavelengths has no effect: track_profile is " + profile);
  if (profile == "none") return;
  if (spectrum) {
    scene.roughness = rough(o, scene, *spectrum);
    scene.profile = scene.roughness->profile(static_cast<std::uint64_t>(o.integer("track_seed")));
    return;
  }
  if (profile.find_first_of("./") == std::string::npos) {
    o.refuse("track_profile",
             "allowed: none, bump, iso8608_A to iso8608_E, german_low, german_high, fra_1 to fra_6, or "
             "a file x,height");
  }
  const std::string path = o.path("track_profile");
  auto columns = options::read_columns(path, 2, 2);
  scene.profile = track::Profile::table(std::move(columns[0]), std::move(columns[1]), "track_profile (" + path + ")");
}

/// Dips and humps on top of the profile.
void read_dips(const Options& o, Scene& scene) {
  if (!o.has("track_dips_x")) {
    if (const options::Entry* entry = o.first_with_prefix("track_dips"))
      o.refuse(entry->name, "belongs to dips, which need track_dips_x");
    return;
  }
  const std::vector<double> x = o.numbers("track_dips_x");
  const std::vector<double> length = o.numbers("track_dips_length", x.size(), "one a dip");
  const std::vector<double> depth = o.numbers("track_dips_depth", x.size(), "one a dip");
  const std::vector<std::string> shape = o.texts("track_dips_shape", x.size(), "one a dip");
  if (scene.roughness)
    o.refuse("track_dips_x", "with a rough track_profile: not there yet; allowed: none, bump or a file");
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (shape[i] == "joint" && depth[i] < 0.0)
      o.refuse("track_dips_depth", "a dip of the shape joint is below 0; allowed: from 0 on");
    scene.profile = scene.profile.with_dip(x[i], length[i], depth[i], shape[i] == "joint");
  }
}

}  // namespace

void read_track(const Options& o, Scene& scene) {
  read_profile(o, scene);
  read_dips(o, scene);
}

}  // namespace traverse::app
