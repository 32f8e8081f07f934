// The layers of a small track, and their text in a scene.
#pragma once

#include <fmt/format.h>

#include <string>

namespace traverse::test {

/// The layers of a track: both rails, N m2 and kg/m; stiffness in N/m, damping in N s/m, masses in kg.
struct TrackLayers {
  double rail_EI, rail_mass;
  double pad_k, pad_c, sleeper_mass;
  double ballast_mass, ballast_k, ballast_c;
  double subballast_k, subballast_c;
};

/// The layers of the reference case R8: two UIC 60 rails on half of Zhai's layers.
inline constexpr TrackLayers r8_layers = {1.32476e7, 121.28,   6.5e7,  7.5e4,  251.0,
                                          531.4,     1.3775e8, 5.88e4, 7.75e7, 3.115e4};
/// Zhai's layers, rounded.
inline constexpr TrackLayers zhai_layers = {1.3e7, 121.0, 1.3e8, 1.5e5, 251.0, 1060.0, 2.7e8, 1.2e5, 1.5e8, 6e4};

/// The YAML of `track`, with sleepers at 0.6 m. `more`: its other options, one on each line after two blanks.
inline std::string track_of(const TrackLayers& t, const std::string& more) {
  return fmt::format(R"(
track:
  rail: {{EI: {}, mass: {}}}
  spacing: 0.6
  pad: {{k: {}, c: {}}}
  sleeper: {{mass: {}}}
  ballast: {{mass: {}, k: {}, c: {}}}
  subballast: {{k: {}, c: {}}}
{})",
                     t.rail_EI, t.rail_mass, t.pad_k, t.pad_c, t.sleeper_mass, t.ballast_mass, t.ballast_k, t.ballast_c,
                     t.subballast_k, t.subballast_c, more);
}

}  // namespace traverse::test
