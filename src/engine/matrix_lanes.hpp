// The matrices of the structures of a batch by elements, in the form that the kernel reads.
#pragma once

#include <memory>
#include <vector>

#include "engine/beam_task.hpp"
#include "engine/elimination_order.hpp"
#include "engine/processor.hpp"

namespace traverse::engine {

/// Symmetric matrices [column][2][block*block], each block by columns: those of a column's unknowns, and of these with
/// the next column's. Without damping if it is proportional.
struct ColumnBlocks {
  const double *mass = nullptr, *damping = nullptr, *stiffness = nullptr;
};

class MatrixLanes {
 public:
  /// One set of matrices for each lane; held: for each unknown whether a support holds it.
  MatrixLanes(int block, const std::vector<char>& held, std::vector<ColumnBlocks> of_lanes);

  /// Sets the matrices and the order of elimination in a task, which points to this object's memory.
  void set(BeamTask& task) const;
  /// The number of rows of BeamTask::factor.
  std::size_t factor_size() const { return order_.factor_size(); }

 private:
  struct Entries {
    std::vector<int> begin{0}, unknown, value;
    std::unique_ptr<Aligned> mass, damping, stiffness;
    MatrixEntries task() const;
  };
  std::size_t place(int i, int j) const;
  bool is_zero(std::size_t place) const;
  bool is_equal(std::size_t place) const;
  void copy_values(Entries& to, const std::vector<std::size_t>& places, bool equal);

  int block_;
  std::vector<ColumnBlocks> of_lanes_;
  EliminationOrder order_;
  Entries equal_, different_;
};

}  // namespace traverse::engine
