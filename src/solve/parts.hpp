// How the nodes of a rank are cut for the elimination. The rank's first node, unless it begins the matrix, and the next
// rank's first node are separators and stay; long ranks are cut further, by separators of their own, into parts. The
// nodes of a part are eliminated from both ends towards the middle one, in two chains that do not depend on each other:
//
//   separator | chain: 0 1 2 ... -> | middle | <- ... 2 1 0 :chain | the next part's separator
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace traverse::solve {

/// Nodes [first, past).
struct Range {
  std::ptrdiff_t first = 0;
  std::ptrdiff_t past = 0;
  bool empty() const { return first >= past; }
  bool contains(std::ptrdiff_t node) const { return first <= node && node < past; }
  Range common(Range other) const { return {std::max(first, other.first), std::min(past, other.past)}; }
};

/// Where the columns of a solve are: node i, component r of column c at x[(i - origin)*block + r + c*stride].
struct Columns {
  double* x;
  std::ptrdiff_t origin;
  std::ptrdiff_t stride;
};

/// Steps k in [from, to) of a chain, each from node k to node k + 1, the middle behind the last. An open run ends
/// before the middle: node `to` is its last.
struct Run {
  std::ptrdiff_t from = 0;
  std::ptrdiff_t to = 0;
  bool open = false;
  std::ptrdiff_t nodes() const { return to - from + (open ? 1 : 0); }
};

struct Chain {
  std::ptrdiff_t first = 0;  // the rank's node where it starts
  std::ptrdiff_t count = 0;  // nodes, the middle not among them
  int direction = 1;         // to the right, or -1: to the left
  bool bordered = false;     // by a separator, before its first node

  /// Nodes [from, past) of the chain as nodes of the rank.
  Range nodes(std::ptrdiff_t from, std::ptrdiff_t past) const {
    return direction > 0 ? Range{first + from, first + past} : Range{first - past + 1, first - from + 1};
  }
  Run run(Range window, std::ptrdiff_t middle) const {
    const Range inside = nodes(0, count).common(window);
    if (inside.empty()) return {};
    const std::ptrdiff_t from = direction > 0 ? inside.first - first : first - inside.past + 1;
    const std::ptrdiff_t past = from + inside.past - inside.first;
    const bool open = past < count || !window.contains(middle);
    return {from, open ? past - 1 : past, open};
  }
};

struct Part {
  Part() = default;

  /// own_nodes: at least one. `follows`: the first is a separator; `is_followed`: there is a separator behind the last.
  Part(Range own_nodes, bool follows, bool is_followed) : nodes(own_nodes), followed(is_followed) {
    const Range inner = {nodes.first + (follows ? 1 : 0), nodes.past};
    if (inner.empty()) return;
    middle = (inner.first + inner.past) / 2;
    chains[0] = {inner.first, middle - inner.first, 1, follows};
    chains[1] = {inner.past - 1, inner.past - 1 - middle, -1, is_followed};
  }

  Range nodes;
  bool followed = false;
  std::ptrdiff_t middle = -1;   // -1: none, nor chains
  std::array<Chain, 2> chains;  // the first is longer by one node or none
};

}  // namespace traverse::solve
