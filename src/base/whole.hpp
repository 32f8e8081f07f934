// Conversion to int of ratios of user values, which may exceed the range of int.
#pragma once

#include <limits>

namespace traverse::base {

/// x truncated to an integer and limited to [-most, most]; `most` for NaN.
inline int whole(double x, int most = std::numeric_limits<int>::max()) {
  if (!(x < most)) return most;
  return x > -most ? static_cast<int>(x) : -most;
}

}  // namespace traverse::base
