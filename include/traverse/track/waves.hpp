// A sum of many cosines with its derivatives, interpolated from a table.
#pragma once

#include <cstdint>
#include <vector>

namespace traverse::track {

struct Height {
  double value = 0.0;      // m
  double slope = 0.0;      // 1
  double curvature = 0.0;  // 1/m
};

/// The sum of a cos(2 pi (f s + phase)). Wheels move in small steps and evaluate the sum many times near each place.
/// The sum is therefore computed at stations 1/96 of the shortest wave apart, when they are first needed, and quintic
/// polynomials interpolate its value and two derivatives between stations. For waves of equal steepness the error is
/// 4e-12 of the shortest wave's height and 2e-8 of its curvature (the test Waves.TableAgainstTheSum records both); it
/// does not depend on earlier evaluations.
class Waves {
 public:
  Waves() = default;
  /// Amplitude (m), frequency (cycles/m) and phase (cycles) of each wave; their number must be a multiple of `lanes`.
  Waves(std::vector<double> amplitude, std::vector<double> frequency, std::vector<double> phase);

  /// The sum interpolated between stored stations.
  Height at(double s) const;
  /// The sum without interpolation.
  Height sum(double s) const;
  /// The sum at `count` places from s with the spacing `distance`. Each wave advances by the same angle from place to
  /// place, which needs a tenth of the time of separate sums. The rounding error grows along the places to 1e-13 of the
  /// waves' heights.
  std::vector<Height> sums(double s, double distance, std::size_t count) const;

  static constexpr int lanes = 4;  // waves computed at once

 private:
  struct Station {
    std::int64_t number = INT64_MIN;
    Height height;
  };
  /// The sum at a station, computed once.
  const Height& station(std::int64_t number) const;

  std::vector<double> amplitude_, frequency_, phase_;
  double spacing_ = 0.0;                   // m
  mutable std::vector<Station> stations_;  // the stations used last, indexed by the last digits of their numbers
};

}  // namespace traverse::track
