// Halves the distance of stations until cubic Hermite interpolation deviates from the profile by at most 2 nm at kinks
// and sample places, and tabulates heights and slopes.
#include "track/height_table.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::track {
namespace {

constexpr double rows_a_wave = 40.0, most_rows = 2e7;
constexpr double most_off = 2e-9;    // m: of a track between its stations; a wheel on steel feels a few N of that
constexpr int checked_places = 200;  // along the track

/// By how much the cubic between the stations before and behind x may miss the track, m: in its middle, and in its
/// quarters, where it is off when a corner lies in the middle.
double off_at(const Profile& profile, double start, double d, double x) {
  const double left = start + std::floor((x - start) / d) * d;
  const Height a = profile.at(left), b = profile.at(left + d);
  double off = 0.0;
  for (const double u : {0.25, 0.5, 0.75}) {
    const double v = 1.0 - u;
    const double cubic =
        v * v * ((1.0 + 2.0 * u) * a.value + u * d * a.slope) + u * u * ((1.0 + 2.0 * v) * b.value - v * d * b.slope);
    off = std::max(off, std::abs(profile.at(left + u * d).value - cubic));
  }
  return off;
}

/// The largest of these at the profile's kinks and sharpest place and at some places between.
double off_between_stations(const Profile& profile, double from, double to, double distance) {
  double off = 0.0;
  std::vector<double> kinks = profile.kinks();
  kinks.push_back(profile.sharpest_place(from, to));
  for (const double kink : kinks)
    for (const double beside : {-0.5, 0.0, 0.5})
      if (kink > from && kink < to) off = std::max(off, off_at(profile, from, distance, kink + beside * distance));
  for (int i = 0; i < checked_places; ++i)
    off = std::max(off, off_at(profile, from, distance, from + (to - from) * (i + 0.5) / checked_places));
  return off;
}

}  // namespace

std::optional<double> table_distance(const Profile& profile, double from, double to) {
  if (profile.level()) return 1.0;
  double distance = std::min(profile.resolution(), profile.shortest_wave() / rows_a_wave);
  const auto fits = [&] { return (to - from) / distance + 2.0 < most_rows; };
  while (fits() && off_between_stations(profile, from, to, distance) > most_off) distance *= 0.5;
  return fits() ? std::optional(distance) : std::nullopt;
}

HeightTable height_table(const Profile& profile, double from, double to, double distance) {
  HeightTable table{from, distance, {}};
  if (profile.level()) return table;
  const double stations = std::ceil((to - from) / distance) + 1.0;
  const std::vector<Height> heights = profile.along(from, distance, static_cast<std::size_t>(stations));
  table.values.reserve(2 * heights.size());
  for (const Height& height : heights) {
    table.values.push_back(height.value);
    table.values.push_back(height.slope * distance);
  }
  return table;
}

}  // namespace traverse::track
