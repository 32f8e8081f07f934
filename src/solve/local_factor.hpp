// One rank's part of the elimination, A = L D L^T by blocks. The rank's first node, unless it begins the matrix, and
// the next rank's first node are separators and stay; the nodes between are eliminated from both ends towards the
// middle one, in two chains that do not depend on each other:
//
//   separator | chain 0: 0 1 2 ... -> | middle | <- ... 2 1 0 :chain 1 | separator of the next rank
//
// A chain that starts beside a separator drags along a coupling to it, the fill. Under a large mass term the fill dies
// out within tens of nodes and its tail is dropped; with springs alone it may reach the middle, and is kept whole.
#pragma once

#include <array>
#include <vector>

#include "panel.hpp"
#include "slice.hpp"
#include "small_block.hpp"
#include "sweep.hpp"

namespace traverse::solve {

/// A chain's factors, a block a node k in the order of elimination. With D_k the pivot block, U_k the coupling to
/// node k + 1 and S_k the coupling of the separator (rows) to node k (columns):
template <int B>
struct Chain {
  std::ptrdiff_t first = 0;     // the slice's node where the chain starts
  std::ptrdiff_t count = 0;     // nodes; one more step leads to the middle
  int direction = 1;            // to the right, or -1: to the left
  std::vector<double> lower;    // U_k^T D_k^{-1}
  std::vector<double> inverse;  // D_k^{-1}
  std::vector<double> fill;     // S_k D_k^{-1}, for the first nodes
};

/// What the elimination leaves for the reduced system of the separators.
template <int B>
struct SchurPart {
  Block<B> own;       // diagonal block of this rank's separator
  Block<B> coupling;  // this rank's separator (rows) with the next rank's (columns)
  Block<B> next;      // added to the diagonal block of the next rank's separator
};

/// The separators' unknowns in C columns: this rank's and the next rank's.
template <int B, int C>
struct SeparatorPanels {
  Panel<B, C> own;
  Panel<B, C> next;
};

template <int B>
class LocalFactor {
 public:
  /// nodes > 0. `follows`: the first node is a separator; `followed`: there is a separator behind the last node.
  LocalFactor(Extent<B> block, std::ptrdiff_t nodes, bool follows, bool followed);

  /// False, and noted in the record, when the slice is not positive definite.
  bool factor(const Slice<B>& slice, PivotRecord& record);
  const SchurPart<B>& schur() const { return schur_; }

  /// First half of a solve in C columns with entries at x + node*block + column*stride: eliminates the inner nodes;
  /// separators.own, in: its right-hand side, out: reduced; separators.next: what is added to the next rank's.
  template <int C>
  void eliminate(double* x, std::ptrdiff_t stride, SeparatorPanels<B, C>& separators) const;

  /// Second half: the inner nodes, from the separators' solutions.
  template <int C>
  void substitute(double* x, std::ptrdiff_t stride, const SeparatorPanels<B, C>& separators) const;

 private:
  struct Front;
  bool eliminate_node(const Slice<B>& slice, std::size_t side, std::ptrdiff_t k, Front& front, PivotRecord& record);
  void extend_fill(Chain<B>& chain, const Block<B>& inverse, const Block<B>& upper, Front& front);
  void pad_fill();
  bool eliminate_middle(const Slice<B>& slice, std::array<Front, 2>& fronts, PivotRecord& record);
  ChainView view(const Chain<B>& chain, double* x) const;

  Extent<B> block_;
  std::ptrdiff_t inner_;        // first inner node
  std::ptrdiff_t middle_ = -1;  // -1: no inner nodes
  bool follows_;
  bool followed_;
  std::array<Chain<B>, 2> chains_;  // the first is longer by one node or none
  std::ptrdiff_t reach_ = 0;        // nodes a chain with fill: the longer fill's, the other padded with zeros
  Block<B> middle_inverse_;
  std::array<Block<B>, 2> middle_fill_;
  SchurPart<B> schur_;
};

}  // namespace traverse::solve
