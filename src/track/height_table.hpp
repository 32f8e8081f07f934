// Heights of a track as cubics between equidistant stations: what many runs look up in place of the profile itself.
#pragma once

#include <optional>
#include <vector>

#include "traverse/track/profile.hpp"

namespace traverse::track {

struct HeightTable {
  double start = 0.0, distance = 1.0;  // m
  std::vector<double> values;          // [station][height, slope*distance], m; empty: level
};

/// m: so far apart stations from `from` to `to` may be that the cubics between them are off by no more than a wheel on
/// steel feels; of a level track any. None: so many stations do not fit into memory, as where the track has corners.
std::optional<double> table_distance(const Profile& profile, double from, double to);
HeightTable height_table(const Profile& profile, double from, double to, double distance);

}  // namespace traverse::track
