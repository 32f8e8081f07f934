// A layered track as a user describes it: rail, pads, sleepers, ballast and sub-ballast, each property as it changes
// along x, and stretches where some of them differ. All of it is for both rails together, in SI units.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/beam/distribution.hpp"

namespace traverse::beam {

/// The springs and dampers of a layer of track along x: N/m and N s/m for each sleeper.
struct Layer {
  Distribution k;
  Distribution c;
};

/// A spring and a damper: N/m and N s/m.
struct Spring {
  double k = 0.0;
  double c = 0.0;
};

/// The properties of the track at one sleeper; zero where the model leaves a layer out.
struct TrackValues {
  Spring pad, ballast, subballast, longitudinal;
  double sleeper_mass = 0.0, ballast_mass = 0.0;  // kg
  double gap = 0.0;                               // m, below the unloaded sleeper, which hangs on the rail
};

struct LayeredTrack;

/// One row of the table of properties, each an option of the track and of every stretch.
struct TrackProperty {
  std::string_view name;  // of the options track_<name> and track_<stretch>_<name>
  std::string_view unit, text;
  double& (*of)(TrackValues& values);
  const Distribution* (*along)(const LayeredTrack& track);  // null where the model leaves the layer out
};
inline constexpr std::size_t track_property_count = 11;

/// Sleepers from `from` to `to`, both included, with properties of their own.
struct TrackStretch {
  std::string name;
  double from = 0.0, to = 0.0;                                           // m
  std::array<std::optional<Distribution>, track_property_count> values;  // by the rows of track_properties
  bool sleepers = true;  // false: neither sleepers nor pads; ballast stays
  bool holds(double x, double rounding) const { return x >= from - rounding && x <= to + rounding; }
};

/// Rail, pads, sleepers, ballast and sub-ballast. On the ground a sleeper stands on its ballast spring, the ballast's
/// mass, the sub-ballast's spring; on the bridge the ballast's spring stands on the beam and its mass rides there, or
/// it is a mass by itself on the sub-ballast's spring as on the ground (own_mass). A layer that is left out is rigid:
/// the sleeper stands on the next one.
struct LayeredTrack {
  Distribution rail_EI, rail_EA, rail_mass;  // N m2, N, kg/m
  std::optional<double> rail_GA;             // N; none: it does not shear
  std::vector<double> rail_hinges;  // stations of joints that carry no moment, m, ascending; at nodes of the rail
  double spacing = 0.6;             // from sleeper to sleeper, m
  double offset = 0.0;              // station of one of them, m
  int elements_per_bay = 2;         // of the rail
  Layer pad;
  Distribution sleeper_mass;  // kg
  std::optional<Layer> ballast;
  Distribution ballast_mass;  // kg a sleeper
  bool own_mass = false;      // the ballast moves by itself on the bridge too
  std::optional<Layer> subballast;
  Layer longitudinal;                   // between rail and bridge, or rail and ground, along x
  Distribution gap;                     // m, below unloaded sleepers
  bool gaps_stay_open = false;          // sleepers over a gap never reach what is below: of small motions
  Spring shear;                         // between neighbouring masses of ballast that move by themselves, N/m, N s/m
  std::vector<TrackStretch> stretches;  // where they overlap the last one counts
  double approach = 0.0;                // of track on either side of the bridge, m; made whole bays

  /// The properties at a sleeper; at a step of a table those to its right.
  TrackValues at(double x) const;
  /// Whether there is a sleeper at this station of the grid.
  bool has_sleeper(double x) const;
  /// Whether some sleepers may hang over a gap.
  bool hangs() const;
  /// Whether every sleeper is like every other.
  bool uniform() const;
};

extern const std::array<TrackProperty, track_property_count> track_properties;

}  // namespace traverse::beam
