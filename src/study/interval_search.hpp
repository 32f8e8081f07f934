// The intervals of a parameter in which a quantity does not exceed its bound, from samples of their ratio, and the
// values at which further samples are needed; and the speeds that a sweep adds near its peaks until each peak is known
// to the wanted accuracy.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace traverse::study {

/// The first and the last value of a run of samples within the bound. An end of the searched range is not the end of
/// the true interval.
struct WithinInterval {
  double from = 0.0, to = 0.0;
  bool from_is_end = false, to_is_end = false;  // of the searched range
};

/// value: ascending; ratio: of the quantity to its bound at each value, within the bound up to 1. NaN is not within it.
std::vector<WithinInterval> intervals_within(const std::vector<double>& value, const std::vector<double>& ratio);

/// Values between those of `value` (ascending), at which the ratios of one or several curves have to be known. Empty:
/// all ends of the intervals of all curves are known to `accuracy`, relative to the value.
///
/// Between two samples on different sides of 1, two values close to the zero of a local interpolation, and the middle
/// if the zero is not in the middle half: each round at least halves the interval, and most rounds divide it by ten.
/// Between two samples on the same side, the middle if the ratio may reach 1 there; the bound of its curvature is that
/// of `refine`.
std::vector<double> values_to_add(const std::vector<double>& value, const std::vector<std::vector<double>>& ratios,
                                  double accuracy);

/// A quantity of one train over the speed.
struct SpeedCurve {
  std::string name;
  std::vector<double> value;  // magnitude at each speed; NaN: not computed
};

/// The greatest value that a curve of samples y at v (ascending) may have between samples i and i + 1: the higher one
/// plus h^2/8 times four times the larger curvature of the parabolas through three neighbours there, because a peak
/// between samples is sharper than its flanks.
double possible_peak(const std::vector<double>& v, const std::vector<double>& y, std::size_t i);

struct Refinement {
  std::vector<double> speeds;  // m/s, ascending, to be added; empty: no interval has to be halved, or none can be
  double uncertainty = 0.0;    // the largest possible excess of a peak over the largest computed value, relative to it
  std::string curve;           // name of the curve with this peak
};

/// The middles of the intervals between speeds (ascending) in which a curve may exceed its largest value by more than
/// `tolerance` of it, by possible_peak. Intervals below 1e-7 of the speed are not halved.
Refinement refine(const std::vector<double>& speed, const std::vector<SpeedCurve>& curves, double tolerance);

/// A limited quantity of one train that is below its limit at all speeds so far.
struct LimitedCurve {
  SpeedCurve curve;
  double limit = 0.0;
};

/// The middles of the intervals between speeds (ascending) in which a resonance may exceed a limit. The resonance width
/// at half power is `width` = 2 zeta, relative to the speed: in the middle of an interval h the peak is hypot(1,
/// h/(width v)) times the value at either end. An interval where this factor is below 1.01 is not halved.
Refinement refine_for_limits(const std::vector<double>& speed, const std::vector<LimitedCurve>& curves, double width);

/// The largest number of speeds after refinement, with and without a tolerance from the user.
inline std::size_t max_speeds(std::size_t given) { return 10 * given + 200; }
inline std::size_t max_speeds_by_default(std::size_t given) { return 3 * given + 50; }

}  // namespace traverse::study
