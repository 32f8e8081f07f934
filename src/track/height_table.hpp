// Heights of a track as cubics between equidistant stations, which many runs evaluate in place of the profile.
#pragma once

#include <optional>
#include <vector>

#include "traverse/track/profile.hpp"

namespace traverse::track {

struct HeightTable {
  double start = 0.0, distance = 1.0;  // m
  std::vector<double> values;          // [station][height, slope*distance], m; empty: level
};

/// The largest distance of stations from `from` to `to`, m, for which the cubics between them are accurate enough for a
/// wheel on steel; arbitrary for a level track. Empty if so many stations do not fit into memory, as for a track with
/// corners.
std::optional<double> table_distance(const Profile& profile, double from, double to);
HeightTable height_table(const Profile& profile, double from, double to, double distance);

}  // namespace traverse::track
