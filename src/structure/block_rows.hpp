// Products with a block tridiagonal matrix whose blocks are mostly zero, for many nodes at a time: each non-zero entry
// of a row's blocks is stored for all nodes. Rows that repeat along the beam are stored once.
#pragma once

#include <vector>

#include "beam/planes.hpp"
#include "solve/block_tridiagonal.hpp"
#include "solve/repeats.hpp"

namespace traverse::structure {

class BlockRows {
 public:
  BlockRows() = default;
  /// left: the block that couples the last column of the left neighbour rank (rows) to this rank's first column
  /// (columns).
  BlockRows(const solve::BlockTridiagonal& rows, const std::vector<double>& left);

  /// r += A x for the nodes [first, past), at most beam::tile. x begins at node first - 1, ends at node past and has
  /// beam::nodes_per_step more readable numbers; its values outside the beam must be finite. `r` begins at node first.
  void add(int first, int past, const beam::Planes& x, const beam::Planes& r) const;

 private:
  struct Entry {
    int row = 0, column = 0;
    int shift = 0;  // 0: of the previous node, 1: of the same node, 2: of the next one
    std::vector<double> along;
    std::ptrdiff_t from = 0, to = 0;  // all other values of `along` are zero
  };
  std::vector<Entry> entries_;   // row by row
  std::vector<int> row_begins_;  // index of each row's first entry, and the end
  solve::StoredSteps stored_;
};

}  // namespace traverse::structure
