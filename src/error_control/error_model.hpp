// How the error of a peak depends on the step or on the length of elements, from what halving them changed.
#pragma once

#include <cstddef>

#include "error_control/search_constants.hpp"

namespace traverse::app {

/// The error of a run, relative to the peak: value * (size/size_of_run)^power.
struct ErrorModel {
  double value = 0.0;
  double order = 2.0;  // measured where `known`, else supposed
  bool known = false;
  bool confirmed = false;  // known before as well
  double change = 0.0;     // what halving changed
  double size = 0.0;       // the step (s), or the length of elements (in spans)

  /// The power law to go by towards longer steps or elements.
  double power() const;
  /// Towards shorter ones, and from a change to the error: errors are not supposed to fall as fast as integrators
  /// promise.
  double power_refining() const;
  /// Times the size that would leave the error `wanted`.
  double room(double wanted) const;
  /// Of a size `times` as large.
  double at(double times) const;
};

/// From what halving the size to `size` changed, and what was known before of another size. Where the change is so much
/// smaller than before that it must be chance, less is believed. most: the highest order there can be.
ErrorModel error_from(double change, double size, const ErrorModel& before, double most = search::full_order);

}  // namespace traverse::app
