// Stretches of the structure: of columns or nodes, [first, past).
#pragma once

#include <algorithm>
#include <vector>

namespace traverse::structure {

struct Range {
  int first = 0, past = 0;
  bool operator==(const Range&) const = default;
};

/// Sorted, with those that overlap or touch in one.
inline std::vector<Range> merged(std::vector<Range> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.first < b.first; });
  std::vector<Range> all;
  for (const Range& r : ranges) {
    if (r.first >= r.past) continue;
    if (!all.empty() && r.first <= all.back().past)
      all.back().past = std::max(all.back().past, r.past);
    else
      all.push_back(r);
  }
  return all;
}

/// What of one list is not in the other, both as merged() has them.
inline std::vector<Range> without(const std::vector<Range>& all, const std::vector<Range>& some) {
  std::vector<Range> rest;
  auto s = some.begin();
  for (Range r : all) {
    for (; s != some.end() && s->past <= r.first; ++s) {
    }
    for (auto inside = s; inside != some.end() && inside->first < r.past; ++inside) {
      if (r.first < inside->first) rest.push_back({r.first, inside->first});
      r.first = std::max(r.first, inside->past);
    }
    if (r.first < r.past) rest.push_back(r);
  }
  return rest;
}

}  // namespace traverse::structure
