// Ranges of columns or nodes of the structure, [first, past), and the columns of a tile, one array for each unknown,
// for products with many nodes at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "beam/line.hpp"

namespace traverse::structure {

struct Range {
  int first = 0, past = 0;
  bool operator==(const Range&) const = default;
};

/// Motion that is set to rest, relative to the largest displacement and velocity so far of each unknown of a column; 0:
/// none is.
struct WindowTolerance {
  double elsewhere = 0.0, at_probes = 0.0;
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

/// Calls body(size of the block as a constant; -1: other sizes), so that the compiler can unroll loops over the block.
template <class Body>
void with_block(int block, Body body) {
  switch (block) {
    case 2:
      return body(std::integral_constant<int, 2>());
    case 3:
      return body(std::integral_constant<int, 3>());
    case 5:
      return body(std::integral_constant<int, 5>());
    case 7:
      return body(std::integral_constant<int, 7>());
    default:
      return body(std::integral_constant<int, -1>());
  }
}

/// The columns from the one before a tile to the one after it, an array for each unknown.
struct Tile {
  std::array<std::array<double, beam::tile + 2 + beam::nodes_per_chunk>, beam::kinds> plane;

  beam::Planes planes() {
    beam::Planes result;
    for (std::size_t c = 0; c < result.size(); ++c) result[c] = plane[c].data();
    return result;
  }
  void clear(int block, int count) {
    for (int c = 0; c < block; ++c) std::fill_n(plane[c].begin(), count, 0.0);
  }
  void separate(int block, const double* columns, int first, int count) {
    with_block(block, [&](auto B) {
      const int b = B > 0 ? B : block;
      for (int i = 0; i < count; ++i)
        for (int c = 0; c < b; ++c) plane[c][first + i] = columns[b * i + c];
    });
  }
  /// columns += factor * the first `count` columns.
  void add_to(int block, int count, double factor, double* columns) const {
    with_block(block, [&](auto B) {
      const int b = B > 0 ? B : block;
      for (int i = 0; i < count; ++i)
        for (int c = 0; c < b; ++c) columns[b * i + c] += factor * plane[c][i];
    });
  }
  void set(int block, int node, const double* column) {
    for (int c = 0; c < block; ++c) plane[c][node] = column[c];
  }
};

}  // namespace traverse::structure
