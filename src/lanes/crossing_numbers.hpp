// The numbers that a crossing's kernel reads (crossing_task.hpp), of runs side by side.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "lanes/crossing.hpp"

namespace traverse::lanes {

/// All that a Task points to, but for its results and its work.
class CrossingNumbers {
 public:
  /// width: lanes, as many as there are runs at least; further lanes repeat the last one. The plan and what the runs
  /// point to must outlive it.
  CrossingNumbers(const CrossingPlan& plan, std::span<const CrossingRun> runs, std::size_t width);
  CrossingNumbers(const CrossingNumbers&) = delete;
  CrossingNumbers& operator=(const CrossingNumbers&) = delete;

  const Task& task() const { return task_; }

 private:
  /// Where a matrix has entries.
  struct Pattern {
    std::vector<int> row{0}, column;
  };
  template <class Has>
  static Pattern pattern_of(int rows, int columns, Has has);
  template <class Value>
  const double* side_by_side(std::size_t count, Value value);
  void add_train(const TrainNumbers& train);
  void add_forces(const ForceNumbers& forces);
  void add_bridge(const structure::ModalBridge& bridge, bool exact_modes);
  void add_track();

  std::span<const CrossingRun> runs_;
  std::size_t width_;
  std::vector<std::unique_ptr<engine::Aligned>> numbers_;
  std::vector<std::unique_ptr<Pattern>> patterns_;
  std::vector<double> largest_;
  std::vector<TaskKind> kinds_;
  std::vector<TaskVehicle> vehicles_;
  double level_until_;
  Task task_;
};

}  // namespace traverse::lanes
