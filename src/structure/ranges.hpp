// Ranges of columns or nodes of the structure, [first, past).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace traverse::structure {

struct Range {
  int first = 0, past = 0;
  bool operator==(const Range&) const = default;
};

/// Sorts the ranges, merges those that overlap or touch, and removes empty ones. Allocates no memory.
inline void merge(std::vector<Range>& ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.first < b.first; });
  std::size_t count = 0;
  for (const Range r : ranges) {
    if (r.first >= r.past) continue;
    if (count > 0 && r.first <= ranges[count - 1].past)
      ranges[count - 1].past = std::max(ranges[count - 1].past, r.past);
    else
      ranges[count++] = r;
  }
  ranges.resize(count);
}

/// Stores the part of one list outside the other in `remaining`; both lists as merge() returns them.
inline void subtract(const std::vector<Range>& all, const std::vector<Range>& removed, std::vector<Range>& remaining) {
  remaining.clear();
  for (Range r : all) {
    for (const Range& s : removed) {
      if (s.past <= r.first || s.first >= r.past) continue;
      if (r.first < s.first) remaining.push_back({r.first, s.first});
      r.first = std::max(r.first, s.past);
    }
    if (r.first < r.past) remaining.push_back(r);
  }
}

}  // namespace traverse::structure
