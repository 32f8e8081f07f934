// Halves the distance of stations until cubic Hermite interpolation deviates from the profile by at most 2 nm at kinks
// and sample places, and tabulates heights and slopes.
#include "track/height_table.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::track {
namespace {

constexpr double rows_per_wave = 40.0, max_rows = 2e7;
constexpr double max_deviation =
    2e-9;  // m: deviation of the cubics from the track; a wheel on steel changes its force by a few N
constexpr int checked_places = 200;  // along the track

/// The deviation of the cubic between the stations around x from the track, m: in its middle, and in its quarters,
/// where it is largest if a corner is in the middle.
double deviation_at(const Profile& profile, double start, double d, double x) {
  const double left = start + std::floor((x - start) / d) * d;
  const Height a = profile.at(left), b = profile.at(left + d);
  double deviation = 0.0;
  for (const double u : {0.25, 0.5, 0.75}) {
    const double v = 1.0 - u;
    const double cubic =
        v * v * ((1.0 + 2.0 * u) * a.value + u * d * a.slope) + u * u * ((1.0 + 2.0 * v) * b.value - v * d * b.slope);
    deviation = std::max(deviation, std::abs(profile.at(left + u * d).value - cubic));
  }
  return deviation;
}

/// The largest deviation at the profile's kinks and sharpest place and at some places between.
double largest_deviation(const Profile& profile, double from, double to, double distance) {
  double deviation = 0.0;
  std::vector<double> kinks = profile.kinks();
  kinks.push_back(profile.sharpest_place(from, to));
  for (const double kink : kinks)
    for (const double offset : {-0.5, 0.0, 0.5})
      if (kink > from && kink < to)
        deviation = std::max(deviation, deviation_at(profile, from, distance, kink + offset * distance));
  for (int i = 0; i < checked_places; ++i)
    deviation =
        std::max(deviation, deviation_at(profile, from, distance, from + (to - from) * (i + 0.5) / checked_places));
  return deviation;
}

}  // namespace

std::optional<double> table_distance(const Profile& profile, double from, double to) {
  if (profile.level()) return 1.0;
  double distance = std::min(profile.resolution(), profile.shortest_wave() / rows_per_wave);
  const auto fits = [&] { return (to - from) / distance + 2.0 < max_rows; };
  while (fits() && largest_deviation(profile, from, to, distance) > max_deviation) distance *= 0.5;
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
