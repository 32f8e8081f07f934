// The search for mesh, method and step of runs side by side.
#pragma once

#include <optional>

#include "error_control/batch_trial_runs.hpp"

namespace traverse::app {

class BatchSearch {
 public:
  /// mixed: the same passages at slow and fast speeds in one group, whose steps are those of the slowest: what the mesh
  /// changes is seen there as well. accuracy: the error that all of it may leave.
  BatchSearch(BatchTrialRuns& trials, BatchTrialRuns& mixed, double accuracy)
      : trials_(trials), mixed_(mixed), accuracy_(accuracy) {}

  /// The model that the search begins with, for passages that last so long, s.
  NumericalModel first(double duration);
  /// The cheapest model within the accuracy; empty: none.
  std::optional<NumericalModel> run(NumericalModel model);
  double error_of_mesh(std::size_t q) const { return mesh_[q]; }
  double error_of_steps(std::size_t q) const { return steps_[q]; }
  /// What a mesh is compared with: one twice as fine.
  NumericalModel on_finer_mesh(NumericalModel model) const;

 private:
  bool predict_step(NumericalModel& model);
  bool halve_step(NumericalModel& model);
  void measure_steps(const NumericalModel& model);
  bool refine_mesh(NumericalModel& model);
  NumericalModel cheaper(const NumericalModel& model);
  PeakErrors left_by(const NumericalModel& tried, const NumericalModel& model);
  double over(const PeakErrors& errors) const;

  BatchTrialRuns &trials_, &mixed_;
  double accuracy_;
  double longest_ = 0.0;    // s: no step is longer
  bool one_solve_ = false;  // methods of one solve a step are tried
  PeakErrors mesh_{}, steps_{};
  PeakErrors halved_{};  // what half the step leaves
};

}  // namespace traverse::app
