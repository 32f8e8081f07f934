// Whole numbers from ratios of what a user gives, which may be larger than any whole number can be.
#pragma once

#include <limits>

namespace traverse::base {

/// x without its fraction, within -most and most; `most` for what is no number.
inline int whole(double x, int most = std::numeric_limits<int>::max()) {
  if (!(x < most)) return most;
  return x > -most ? static_cast<int>(x) : -most;
}

}  // namespace traverse::base
