// Speeds that a sweep adds by itself near its peaks, until it knows each of them as well as is wanted.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace traverse::app {

/// A quantity of one train over the speed.
struct SpeedCurve {
  std::string name;
  std::vector<double> value;  // at every speed, a magnitude; NaN: not known
};

struct Refinement {
  std::vector<double> speeds;  // m/s, ascending, to be added; empty: every peak is known well enough, or no better
  double uncertainty = 0.0;    // the most that a peak may be above the largest known value, over that value
  std::string curve;           // of that peak
};

/// The middles of those intervals between speeds (ascending) in which a curve may rise above its largest value by more
/// than `tolerance` of it: above both ends by h^2/8 times four times the larger bend of the parabolas through three
/// neighbours there, as a peak that no sample has met is sharper than its flanks show. Intervals below 1e-7 of the
/// speed are not halved.
Refinement refine(const std::vector<double>& speed, const std::vector<SpeedCurve>& curves, double tolerance);

/// A quantity of one train that is limited, below its limit at all speeds so far.
struct LimitedCurve {
  SpeedCurve curve;
  double limit = 0.0;
};

/// The middles of those intervals between speeds (ascending) in which a resonance may break a limit. Its width at half
/// power is `width` of the speed, 2 zeta: in the middle of an interval h its peak is hypot(1, h/(width v)) times what
/// either end has. Where that is within a hundredth the interval is short enough.
Refinement refine_for_limits(const std::vector<double>& speed, const std::vector<LimitedCurve>& curves, double width);

/// How many speeds there may be where so many were given, and where no more were asked for.
inline std::size_t most_speeds(std::size_t given) { return 10 * given + 200; }
inline std::size_t most_speeds_unasked(std::size_t given) { return 3 * given + 50; }

}  // namespace traverse::app
