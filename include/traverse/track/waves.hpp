// A sum of many cosines with its derivatives, from a table of its own.
#pragma once

#include <cstdint>
#include <vector>

namespace traverse::track {

struct Height {
  double value = 0.0;      // m
  double slope = 0.0;      // 1
  double curvature = 0.0;  // 1/m
};

/// sum a cos(2 pi (f s + phase)). Wheels come along in small steps and look many times near each place: the sum is
/// formed at stations 1/96 of the shortest wave apart, as they are needed, and quintic polynomials take its value and
/// two derivatives from one to the next. For waves of equal steepness that is off by 4e-12 of the
/// shortest one's height and 2e-8 of its curvature (test Waves.TableAgainstTheSum records both), and does not depend on
/// what was asked before.
class Waves {
 public:
  Waves() = default;
  /// m, cycles/m and cycles of each wave, their number a multiple of `lanes`.
  Waves(std::vector<double> amplitude, std::vector<double> frequency, std::vector<double> phase);

  /// Interpolated between stations whose sums are kept.
  Height at(double s) const;
  /// The sum itself.
  Height sum(double s) const;
  /// The sum at `count` places from s on, `distance` apart: each wave turns on by the same angle from place to place,
  /// which takes a tenth of the time of as many sums. Rounding grows along the way to 1e-13 of the waves' heights.
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
  mutable std::vector<Station> stations_;  // those looked at last, by their number's last digits
};

}  // namespace traverse::track
