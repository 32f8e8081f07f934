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

/// How many speeds there may be where so many were given.
inline std::size_t most_speeds(std::size_t given) { return 10 * given + 200; }

}  // namespace traverse::app
