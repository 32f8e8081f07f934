// Products with a block tridiagonal matrix whose blocks are mostly zero, for many nodes at a time. The block row of a
// node has one row for each of its unknowns. An entry that is non-zero at some node is stored for all nodes; block rows
// that repeat along the beam are stored once.
#pragma once

#include <vector>

#include "beam/line.hpp"
#include "solve/block_tridiagonal.hpp"
#include "solve/repeats.hpp"

namespace traverse::structure {

class BlockRows {
 public:
  BlockRows() = default;
  /// left: the block that couples the last column of the left neighbour rank (rows) to this rank's first column
  /// (columns).
  BlockRows(const solve::BlockTridiagonal& matrix, const std::vector<double>& left);

  /// r += A x for the nodes [first, past), at most beam::tile. x begins at node first - 1, ends at node past and has
  /// beam::nodes_per_chunk more readable numbers; its values outside the beam must be finite. `r` begins at node first.
  void add(int first, int past, const beam::Planes& x, const beam::Planes& r) const;

 private:
  struct Entry {
    int unknown = 0, column = 0;
    int shift = 0;  // 0: block with the previous node, 1: with the node itself, 2: with the next node
    std::vector<double> values;
    std::ptrdiff_t from = 0, to = 0;  // all other values are zero
  };
  std::vector<Entry> entries_;       // unknown by unknown
  std::vector<int> unknown_begins_;  // index of each unknown's first entry, and the end
  solve::StoredSequence stored_;
};

}  // namespace traverse::structure
