// The order in which the unknowns of a structure's columns are eliminated, and the links that this causes: the symbolic
// part of the factorisation in lanes (beam_factor.hpp).
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "engine/beam_task.hpp"

namespace traverse::engine {

class EliminationOrder {
 public:
  /// coupled(i, j): whether the matrices couple two unknowns of a column, or of neighbouring columns. Small columns
  /// (most_dense) are taken as coupled throughout.
  EliminationOrder(int block, int columns, const std::function<bool(int, int)>& coupled);

  /// Sets the orders of columns and pairs in a task, which points to this object's memory.
  void set(BeamTask& task) const;
  /// The number of rows of BeamTask::factor.
  std::size_t factor_size() const { return factor_size_; }

 private:
  using Offsets = std::vector<int>;  // unknowns, counted from their column's first
  using Coupled = std::function<bool(int, int)>;
  Offsets coupled_with(const Coupled& coupled, int column, int other) const;
  const ColumnOrder* order_of(const Coupled& coupled, int column, const Offsets& outer);
  const PairOrder* pair_of(const Offsets& further, const Offsets& nearer);

  int block_;
  std::map<std::vector<int>, ColumnOrder> orders_;  // few different ones
  std::map<std::vector<Offsets>, PairOrder> pairs_;
  std::vector<const ColumnOrder*> of_column_;
  std::vector<const PairOrder*> to_right_, to_left_;
  std::vector<int> link_begin_, pair_begin_;
  std::size_t factor_size_ = 0;
};

}  // namespace traverse::engine
