// A closed interval of numbers.
#pragma once

#include <limits>

namespace traverse::base {

/// From `from` to `to`; at first all numbers.
struct Interval {
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();

  bool overlaps(const Interval& other) const { return from <= other.to && other.from <= to; }
};

}  // namespace traverse::base
