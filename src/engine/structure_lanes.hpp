// The structures of a batch's runs in the form that the kernel reads, shared by all runs, or one in each lane: their
// matrices by elements, and the order in which the unknowns of their columns are eliminated.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/batch.hpp"
#include "engine/batch_task.hpp"
#include "engine/processor.hpp"

namespace traverse::engine {

/// The order in which the unknowns of a structure's columns are eliminated, and the links that this causes: the
/// symbolic part of the factorisation in lanes (beam_factor.hpp).
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

class StructureLanes {
 public:
  /// One structure for each lane, all of the same layout. They must outlive this object.
  explicit StructureLanes(std::span<const BatchStructure* const> of_lanes);

  /// Without the arrays of the runs' motion.
  const BeamTask& task() const { return task_; }
  /// The number of rows of BeamTask::factor.
  std::size_t factor_size() const { return matrices_ ? matrices_->factor_size() : 0; }
  const std::vector<ProbeForms>& probes() const { return probes_; }
  const std::vector<LinearForm>& rotations() const { return rotations_; }
  const std::vector<SurfaceTable>& surfaces() const { return surfaces_; }
  /// The index of the surface of a lane's wheels with this radius, m.
  std::size_t surface(std::size_t lane, double radius) const;
  /// Whether moments lag behind (PeakState::lags), and their lag in a row, s.
  bool lags() const { return of_lanes_.front()->by_stiffness_ > 0.0; }
  const double* lag() const { return task_.by_stiffness; }

 private:
  template <class Numbers>
  const double* row_of(Numbers number);
  template <class Numbers>
  const double* entries(std::size_t count, Numbers numbers);
  template <class Numbers>
  const double* in_rows(std::size_t count, Numbers numbers);
  void add_probe(std::size_t index);

  std::span<const BatchStructure* const> of_lanes_;
  BeamTask task_;
  std::optional<MatrixLanes> matrices_;  // by elements
  std::vector<ProbeForms> probes_;
  std::vector<LinearForm> rotations_;
  std::vector<SurfaceTable> surfaces_;
  std::vector<std::size_t> first_surface_;  // of each lane
  std::vector<std::unique_ptr<Aligned>> numbers_;
};

}  // namespace traverse::engine
