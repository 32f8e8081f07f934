// Products with a block tridiagonal matrix whose blocks are mostly zero, many nodes at a time: the non-zero entries of
// a row's blocks, each along all nodes. Where rows repeat along the beam their numbers are kept once.
#pragma once

#include <vector>

#include "beam/planes.hpp"
#include "solve/block_tridiagonal.hpp"
#include "solve/repeats.hpp"

namespace traverse::structure {

class BlockRows {
 public:
  BlockRows() = default;
  /// left: the block that couples the neighbour rank's last column (rows) to the first (columns).
  BlockRows(const solve::BlockTridiagonal& rows, const std::vector<double>& left);

  /// r += A x for the nodes [first, past), at most beam::tile. x begins at node first - 1, ends at node past and
  /// has beam::abreast numbers to read behind; what it holds beyond the beam has to be finite. `r` begins at node
  /// first.
  void add(int first, int past, const beam::Planes& x, const beam::Planes& r) const;

 private:
  struct Entry {
    int row = 0, column = 0;
    int shift = 0;  // 0: of the node before, 1: of its own, 2: of the next
    std::vector<double> along;
    std::ptrdiff_t from = 0, to = 0;  // all others are zero
  };
  std::vector<Entry> entries_;   // row by row
  std::vector<int> row_begins_;  // their first entries, and the end
  solve::StoredSteps stored_;
};

}  // namespace traverse::structure
