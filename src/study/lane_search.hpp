// The search for modes, mesh, method and step of runs by the lanes' kernel.
#pragma once

#include <optional>

#include "study/lane_trials.hpp"

namespace traverse::app {

class LaneSearch {
 public:
  /// mixed: the same passages at slow and fast speeds in one group, whose steps are those of the slowest: what modes
  /// and mesh change is seen there as well. accuracy: the error that all of it may leave.
  LaneSearch(LaneTrials& trials, LaneTrials& mixed, double accuracy)
      : trials_(trials), mixed_(mixed), accuracy_(accuracy) {}

  /// The cheapest model within the accuracy, by steps that begin with this one, s; empty: none.
  std::optional<LaneModel> run(double first_step);
  /// Of modes and mesh, and of the steps.
  double error_of_model(std::size_t q) const { return modes_[q] + mesh_[q]; }
  double error_of_steps(std::size_t q) const { return steps_[q]; }

 private:
  bool halve_step(LaneModel& model);
  bool add_modes(LaneModel& model);
  LaneModel with_more_modes(const LaneModel& model);
  bool refine_mesh(LaneModel& model);
  LaneModel cheaper(const LaneModel& model);

  LaneTrials &trials_, &mixed_;
  double accuracy_;
  int dense_ = 0;  // elements a span that the number of modes was found with
  LaneErrors modes_{}, steps_{}, mesh_{};
};

}  // namespace traverse::app
