// A layered track as the user describes it: rail, pads, sleepers, ballast and sub-ballast with properties along x, and
// stretches with different properties. All values are for both rails together, in SI units.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/beam/foundation.hpp"

namespace traverse::beam {

/// The springs and dampers of one layer of the track along x: N/m and N s/m per sleeper.
struct Layer {
  Distribution k;
  Distribution c;
};

/// A spring and a damper: N/m and N s/m.
struct Spring {
  double k = 0.0;
  double c = 0.0;
};

/// The properties of the track at one sleeper; zero for layers that the model does not contain.
struct TrackValues {
  Spring pad, ballast, subballast, longitudinal;
  double sleeper_mass = 0.0, ballast_mass = 0.0;  // kg
  double gap = 0.0;                               // m, below the unloaded sleeper, which the rail carries
  /// Limit of the longitudinal spring, N (0: it never slides); its stiffness, N/m, and limit, N, under a train (0:
  /// equal to the values without a train).
  double slides_at = 0.0, loaded_k = 0.0, loaded_slides_at = 0.0;

  /// The law of the longitudinal spring.
  Sliding sliding() const {
    return {longitudinal.k, slides_at, loaded_k > 0.0 ? loaded_k : longitudinal.k,
            loaded_slides_at > 0.0 ? loaded_slides_at : slides_at};
  }
};

struct LayeredTrack;

/// A row of the table of properties, each an option of the track and of every stretch.
struct TrackProperty {
  std::string_view name;  // NAME in the options track_NAME and track_STRETCH_NAME
  std::string_view unit, text;
  double& (*of)(TrackValues& values);
  const Distribution* (*along)(const LayeredTrack& track);  // null if the model does not contain the layer
};
inline constexpr std::size_t track_property_count = 14;

/// A part of the track with different properties: the sleepers from `from` to `to`, both included.
struct TrackStretch {
  std::string name;
  double from = 0.0, to = 0.0;                                           // m
  std::array<std::optional<Distribution>, track_property_count> values;  // in the order of track_properties
  bool sleepers = true;  // false: there is ballast, but no sleepers and pads
  bool contains(double x, double rounding) const { return x >= from - rounding && x <= to + rounding; }
};

/// Rail, pads, sleepers, ballast and sub-ballast. On the ground the ballast spring, the ballast's mass and the
/// sub-ballast's spring carry a sleeper in series. On the bridge the ballast spring acts on the beam and the ballast's
/// mass moves with the beam, or the ballast is a separate mass on the sub-ballast's spring as on the ground (own_mass).
/// A layer that the model does not contain is rigid: the sleeper acts on the next layer.
struct LayeredTrack {
  Distribution rail_EI, rail_EA, rail_mass;  // N m2, N, kg/m
  std::optional<double> rail_GA;             // N; empty: no shear deformation
  std::vector<double> rail_hinges;           // stations of joints without moment, m, ascending; at nodes of the rail
  std::vector<double> expansion_devices;     // stations at which u may jump, m, ascending; at nodes between sleepers
  double spacing = 0.6;                      // between sleepers, m
  double offset = 0.0;                       // station of one sleeper, m
  int elements_per_bay = 2;                  // elements of the rail between two sleepers
  Layer pad;
  Distribution sleeper_mass;  // kg
  std::optional<Layer> ballast;
  Distribution ballast_mass;  // kg per sleeper
  bool own_mass = false;      // the ballast is a separate mass on the bridge too
  std::optional<Layer> subballast;
  Layer longitudinal;      // between rail and bridge, or rail and ground, along x
  Distribution slides_at;  // N per sleeper: limit of the longitudinal spring; 0: it never slides
  Distribution loaded_k,
      loaded_slides_at;  // N/m and N: stiffness and limit under a train; 0: equal to the values without a train
  bool sliding_disabled = false;  // the longitudinal spring never slides, for small motions
  double rail_temperature = 0.0;  // K, change since the rail was laid
  double rail_expansion = 0.0;    // 1/K
  bool rail_ends_held = false;    // the rail's ends are held along x, as by a track that continues; false: free
  Distribution gap;               // m, below unloaded sleepers
  bool gaps_stay_open = false;    // sleepers never close a gap, for small motions
  Spring shear;                   // between neighbouring separate ballast masses, N/m, N s/m
  std::vector<TrackStretch>
      stretches;          // parts of the track with other properties; where they overlap, the last one applies
  double approach = 0.0;  // length of the track on either side of the bridge, m; adjusted to whole bays

  /// The properties at a sleeper; at a jump of a table the values on its right.
  TrackValues at(double x) const;
  /// Whether this station of the grid has a sleeper.
  bool has_sleeper(double x) const;
  /// Whether the property of this name is positive at some sleepers.
  bool any_positive(std::string_view name) const;
  /// Whether some sleepers may hang over a gap.
  bool hangs() const;
  /// Whether some longitudinal springs may slide.
  bool slides() const;
  /// Whether all sleepers have equal properties.
  bool uniform() const;
};

extern const std::array<TrackProperty, track_property_count> track_properties;

}  // namespace traverse::beam
