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
#include "traverse/beam/foundation_law.hpp"

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
  /// Of the longitudinal spring, N, and with its stiffness, N/m, below a train; 0: it holds, and it is the same there.
  double slides_at = 0.0, loaded_k = 0.0, loaded_slides_at = 0.0;

  /// The law of the longitudinal spring.
  Sliding sliding() const {
    return {longitudinal.k, slides_at, loaded_k > 0.0 ? loaded_k : longitudinal.k,
            loaded_slides_at > 0.0 ? loaded_slides_at : slides_at};
  }
};

struct LayeredTrack;

/// One row of the table of properties, each an option of the track and of every stretch.
struct TrackProperty {
  std::string_view name;  // of the options track_<name> and track_<stretch>_<name>
  std::string_view unit, text;
  double& (*of)(TrackValues& values);
  const Distribution* (*along)(const LayeredTrack& track);  // null where the model leaves the layer out
};
inline constexpr std::size_t track_property_count = 14;

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
  std::vector<double> rail_hinges;        // stations of joints that carry no moment, m, ascending; at nodes of the rail
  std::vector<double> expansion_devices;  // stations where it may lengthen, m, ascending; at nodes between sleepers
  double spacing = 0.6;                   // from sleeper to sleeper, m
  double offset = 0.0;                    // station of one of them, m
  int elements_per_bay = 2;               // of the rail
  Layer pad;
  Distribution sleeper_mass;  // kg
  std::optional<Layer> ballast;
  Distribution ballast_mass;  // kg a sleeper
  bool own_mass = false;      // the ballast moves by itself on the bridge too
  std::optional<Layer> subballast;
  Layer longitudinal;                       // between rail and bridge, or rail and ground, along x
  Distribution slides_at;                   // N a sleeper: where the longitudinal spring slides; 0: it holds
  Distribution loaded_k, loaded_slides_at;  // N/m and N: the same below a train; 0: as without one
  bool holds_fast = false;                  // it never slides: of small motions
  double rail_temperature = 0.0;            // K, since the rail was laid
  double rail_expansion = 0.0;              // 1/K
  bool rail_ends_held = false;              // along x, as where the track goes on; false: free
  Distribution gap;                         // m, below unloaded sleepers
  bool gaps_stay_open = false;              // sleepers over a gap never reach what is below: of small motions
  Spring shear;                         // between neighbouring masses of ballast that move by themselves, N/m, N s/m
  std::vector<TrackStretch> stretches;  // where they overlap the last one counts
  double approach = 0.0;                // of track on either side of the bridge, m; made whole bays

  /// The properties at a sleeper; at a step of a table those to its right.
  TrackValues at(double x) const;
  /// Whether there is a sleeper at this station of the grid.
  bool has_sleeper(double x) const;
  /// Whether a property, by its name, is above zero at some sleepers.
  bool somewhere(std::string_view name) const;
  /// Whether some sleepers may hang over a gap.
  bool hangs() const;
  /// Whether some longitudinal springs may slide.
  bool slides() const;
  /// Whether every sleeper is like every other.
  bool uniform() const;
};

extern const std::array<TrackProperty, track_property_count> track_properties;

}  // namespace traverse::beam
