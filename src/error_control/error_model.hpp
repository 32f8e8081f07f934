// Model of a peak's error over the step or element length, e = c h^p, from successive halvings.
#pragma once

#include <cstddef>

#include "error_control/search_constants.hpp"

namespace traverse::error_control {

/// The error of a run, relative to the peak: value * (size/size_of_run)^power.
struct ErrorModel {
  double value = 0.0;
  double order = 2.0;  // measured if `known`, otherwise assumed
  bool known = false;
  bool confirmed = false;  // was known before the last halving too
  double change = 0.0;     // change by the last halving
  double size = 0.0;       // step (s) or element length (spans)

  /// The exponent for longer time steps or elements.
  double power() const;
  /// The exponent for shorter time steps or elements, and for the error from a change. It is limited, because errors
  /// may decrease more slowly than the order of the method.
  double power_refining() const;
  /// The ratio of sizes at which the error is `wanted`.
  double allowed_ratio(double wanted) const;
  /// The error at `ratio` times the size.
  double at(double ratio) const;
};

/// The model from the change by halving the size to `size`, and the model `before` of another size. A change that is so
/// much smaller than before that it must be accidental is corrected. max_order: the largest possible order.
ErrorModel error_from(double change, double size, const ErrorModel& before, double max_order = search::full_order);

}  // namespace traverse::error_control
