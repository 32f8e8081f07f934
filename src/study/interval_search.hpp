// The intervals of a parameter in which a quantity does not exceed its bound, from samples of their ratio, and the
// values at which further samples are needed.
#pragma once

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
/// of `refine` (speed_refinement.hpp).
std::vector<double> values_to_add(const std::vector<double>& value, const std::vector<std::vector<double>>& ratios,
                                  double accuracy);

}  // namespace traverse::study
