// The division of a rank's nodes for the elimination. The rank's first node, unless it is the first of the matrix, and
// the next rank's first node are separators, which are not eliminated. Further separators divide long ranks into parts.
// The nodes of a part are eliminated from both ends towards the middle one, in two independent chains:
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

/// The memory of the columns of a solve: node i, component r of column c is at x[(i - origin)*block + r + c*stride].
struct Columns {
  double* x;
  std::ptrdiff_t origin;
  std::ptrdiff_t stride;
};

/// Steps k in [from, to) of a chain, each from node k to node k + 1; the middle follows the last node. An open run ends
/// before the middle: node `to` is its last node.
struct Run {
  std::ptrdiff_t from = 0;
  std::ptrdiff_t to = 0;
  bool open = false;
  std::ptrdiff_t nodes() const { return to - from + (open ? 1 : 0); }
};

struct Chain {
  std::ptrdiff_t first = 0;  // node of the rank at which it starts
  std::ptrdiff_t count = 0;  // number of nodes, without the middle
  int direction = 1;         // 1: to the right, -1: to the left
  bool bordered = false;     // a separator is before its first node

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

  /// own_nodes: at least one. `follows`: the first is a separator; `is_followed`: a separator follows the last one.
  Part(Range own_nodes, bool follows, bool is_followed) : nodes(own_nodes), followed(is_followed) {
    const Range inner = {nodes.first + (follows ? 1 : 0), nodes.past};
    if (inner.empty()) return;
    middle = (inner.first + inner.past) / 2;
    chains[0] = {inner.first, middle - inner.first, 1, follows};
    chains[1] = {inner.past - 1, inner.past - 1 - middle, -1, is_followed};
  }

  Range nodes;
  bool followed = false;
  std::ptrdiff_t middle = -1;   // -1: the part has no middle and no chains
  std::array<Chain, 2> chains;  // the first one has one node more, or as many
};

}  // namespace traverse::solve
