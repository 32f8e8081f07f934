// The structures of a batch's runs in the form that the kernel reads: shared by all runs, or one in each lane.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/batch.hpp"
#include "engine/matrix_lanes.hpp"
#include "engine/processor.hpp"

namespace traverse::engine {

class StructureLanes {
 public:
  /// One structure for each lane, all of the same layout. They must outlive this object.
  explicit StructureLanes(std::span<const BatchStructure* const> of_lanes);

  /// Without the arrays of the runs' motion.
  const BeamTask& task() const { return task_; }
  /// The number of rows of BeamTask::factor.
  std::size_t factor_size() const { return matrices_ ? matrices_->factor_size() : 0; }
  const std::vector<ProbeForms>& probes() const { return probes_; }
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
  std::vector<SurfaceTable> surfaces_;
  std::vector<std::size_t> first_surface_;  // of each lane
  std::vector<std::unique_ptr<Aligned>> numbers_;
};

}  // namespace traverse::engine
