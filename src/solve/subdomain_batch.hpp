// The division of a rank's nodes for the elimination. The rank's first node, unless it is the first of the matrix, and
// the next rank's first node are separators, which are not eliminated. Further separators divide long ranks into parts.
// The nodes of a part are eliminated from both ends towards the middle one, in two independent chains:
//
//   separator | chain: 0 1 2 ... -> | middle | <- ... 2 1 0 :chain | the next part's separator
//
// Neighbouring parts are eliminated together, A = L D L^T by blocks, with all their chains in one loop.
//
// A chain that starts at a separator has a coupling to it in every node, the fill. Under a large mass term the fill
// decays within tens of nodes, and its negligible tail is dropped; with springs alone it may reach the middle and is
// stored completely.
//
// If the rows of all chains repeat, and their pivot blocks repeat to rounding, the values of one period are used for
// all periods that follow (Stored): this is equivalent to a change of the matrix's pivot blocks of this magnitude.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "panel.hpp"
#include "repeats.hpp"
#include "slice.hpp"
#include "solve/block_tridiagonal.hpp"
#include "sweep.hpp"

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

inline constexpr std::size_t parts_per_batch = lanes / 2;

/// One entry of the factors for each chain.
struct alignas(lanes * sizeof(double)) LaneEntry {
  std::array<double, lanes> chain;
};

/// The contributions of a part to the reduced system of the separators.
template <int B>
struct SchurPart {
  Block<B> own;       // diagonal block of the part's separator
  Block<B> coupling;  // the part's separator (rows) with the next part's (columns)
  Block<B> next;      // added to the diagonal block of the next part's separator
};

/// The unknowns of the separators before (even) and behind (odd) the chains of a batch.
template <int B, int C>
using ChainBorders = std::array<Panel<B, C>, lanes>;

template <int B>
class SubdomainBatch {
 public:
  /// Empty parts have no nodes.
  SubdomainBatch(Extent<B> block, const std::array<Part, parts_per_batch>& parts);

  const std::array<Part, parts_per_batch>& parts() const { return parts_; }
  Range nodes() const { return nodes_; }

  /// Returns false, with an entry in the record, if a part is not positive definite.
  bool factor(const Slice<B>& slice, PivotRecord& record);
  const SchurPart<B>& schur(std::size_t part) const { return schur_[part]; }
  /// Number of stored values of the chains.
  std::size_t stored_numbers() const { return lanes * (lower_.size() + inverse_.size() + fill_.size()); }

  /// First half of a solve within a window: eliminates the inner nodes, after the callback (unless null) has written
  /// them. borders, out: contributions to the separators' right-hand sides.
  template <int C>
  void forward(const Columns& x, Range window, RhsCallback* rhs_callback, ChainBorders<B, C>& borders) const;

  /// Second half: computes the inner nodes from the separators' solutions.
  template <int C>
  void backward(const Columns& x, Range window, const ChainBorders<B, C>& borders) const;

  /// Both halves for a single part without separators, for all its nodes.
  template <int C>
  void solve_single(const Columns& x) const;

 private:
  struct Front;

  /// Steps [from, to) of the chains whose bits are set, either all with fill or all without.
  struct StepRange {
    std::ptrdiff_t from;
    std::ptrdiff_t to;
    unsigned chains;
  };
  struct Plan {
    std::array<Run, lanes> runs;
    std::array<StepRange, 2 * lanes + 1> ranges;
    std::size_t count = 0;
  };
  Plan plan(Range window) const;
  const Plan& plan(Range window, Plan& buffer) const {
    if (window.first <= nodes_.first && window.past >= nodes_.past) return full_plan_;
    return buffer = plan(window);
  }

  const Chain& chain(std::size_t lane) const { return parts_[lane / 2].chains[lane % 2]; }
  bool eliminate_chains(const Slice<B>& slice, std::array<Front, lanes>& fronts, PivotRecord& record);
  void extend_store() {
    lower_.resize(lower_.size() + static_cast<std::size_t>(block_.area()));
    inverse_.resize(inverse_.size() + static_cast<std::size_t>(block_.triangle()));
  }
  bool eliminate_node(const Slice<B>& slice, std::size_t lane, std::ptrdiff_t k, Front& front, PivotRecord& record);
  void extend_fill(const Block<B>& inverse, const Block<B>& upper, Front& front) const;
  std::ptrdiff_t node(std::size_t lane, std::ptrdiff_t k) const {
    return chain(lane).first + k * chain(lane).direction;
  }
  Block<B> coupling(const Slice<B>& slice, std::size_t lane, std::ptrdiff_t k) const;
  Block<B> stored_inverse(std::size_t lane, std::ptrdiff_t k) const;
  std::vector<std::uint64_t> hashes(const Slice<B>& slice) const;
  bool same_rows(const Slice<B>& slice, std::ptrdiff_t k, std::ptrdiff_t period) const;
  bool same_pivots(const Slice<B>& slice, std::ptrdiff_t k, std::ptrdiff_t period) const;
  std::ptrdiff_t repeat(const Slice<B>& slice, std::ptrdiff_t from, std::ptrdiff_t period,
                        std::array<Front, lanes>& fronts);
  bool eliminate_middle(const Slice<B>& slice, std::size_t part, Front* fronts, PivotRecord& record);
  void store_fill(const std::array<Front, lanes>& fronts);

  static const double* first(const std::vector<LaneEntry>& entries, std::ptrdiff_t entry, std::size_t lane) {
    return entries.data() == nullptr ? nullptr : (entries.data() + entry)->chain.data() + lane;
  }
  Factors factors(std::size_t lane, std::ptrdiff_t k) const;
  double* address(const Columns& x, std::ptrdiff_t node) const { return x.x + (node - x.origin) * block_.size(); }
  // The sweep over the elimination steps from k on, counted from k.
  LaneSweep<B> lane_sweep(const Columns& x, std::ptrdiff_t k) const;
  template <int C, std::size_t N>
  ColumnSweep<B, C, N> column_sweep(const Columns& x, std::size_t lane, std::ptrdiff_t k) const;
  template <int C, class Body>
  void along_columns(const Columns& x, const StepRange& steps, Body body) const;
  template <bool Fill, int C>
  void forward(const Columns& x, const StepRange& steps, ChainBorders<B, C>& borders) const;
  template <bool Fill, int C>
  void backward(const Columns& x, const StepRange& steps, const ChainBorders<B, C>& borders) const;
  template <int C, bool Packed>
  void solve_single(double* x, std::ptrdiff_t stride) const;
  template <int C>
  void solve_middle(const Columns& x, std::size_t part, const ChainBorders<B, C>& borders) const;
  template <int C>
  void forward_end(const Columns& x, std::size_t lane, std::ptrdiff_t k, Panel<B, C>& border) const;
  template <int C>
  void backward_end(const Columns& x, std::size_t lane, std::ptrdiff_t k, const Panel<B, C>& border) const;

  Extent<B> block_;
  std::array<Part, parts_per_batch> parts_;
  Range nodes_;
  std::ptrdiff_t steps_ = 0;         // steps of the longest chain
  std::ptrdiff_t common_steps_ = 0;  // steps that all chains have, without the steps to a middle
  std::ptrdiff_t fill_nodes_ =
      0;  // nodes per chain with fill: the number of the longest fill; the other chains are padded with zeros

  // With the pivot block D_k, the coupling U_k to node k + 1 and the coupling S_k of the separator (rows) to node k
  // (columns), in the layout of Factors, the first two by storage indices:
  StoredSequence stored_;
  std::vector<LaneEntry> lower_;    // U_k^T D_k^{-1}
  std::vector<LaneEntry> inverse_;  // D_k^{-1}
  std::vector<LaneEntry> fill_;     // S_k D_k^{-1}
  std::array<Block<B>, parts_per_batch> middle_inverse_;
  std::array<Block<B>, lanes> middle_fill_;
  std::array<SchurPart<B>, parts_per_batch> schur_;
  Plan full_plan_;
};

}  // namespace traverse::solve
