// Searches mesh, method and step of batched runs.
#pragma once

#include <optional>
#include <vector>

#include "error_control/batch_trial_runs.hpp"

namespace traverse::error_control {

class BatchSearch {
 public:
  /// mixed: the same passages at slow and fast speeds in one group with the steps of the slowest, which reveal further
  /// errors of the mesh. accuracy: limit of the total error.
  BatchSearch(BatchTrialRuns& trials, BatchTrialRuns& mixed, double accuracy)
      : trials_(trials), mixed_(mixed), accuracy_(accuracy) {}

  /// The initial model for passages of `duration`, s.
  scene::NumericalModel first(double duration);
  /// The cheapest model within the accuracy; empty: none.
  std::optional<scene::NumericalModel> run(scene::NumericalModel model);
  double error_of_mesh(std::size_t q) const { return mesh_[q]; }
  double error_of_steps(std::size_t q) const { return steps_[q]; }
  /// The mesh of comparison, with twice the elements.
  scene::NumericalModel on_finer_mesh(scene::NumericalModel model) const;

 private:
  bool predict_step(scene::NumericalModel& model);
  bool halve_step(scene::NumericalModel& model);
  void measure_steps(const scene::NumericalModel& model);
  bool refine_mesh(scene::NumericalModel& model);
  scene::NumericalModel find_cheaper(const scene::NumericalModel& model);
  PeakErrors errors_of(const scene::NumericalModel& candidate, const scene::NumericalModel& model);
  double error_ratio(const PeakErrors& errors) const;

  BatchTrialRuns &trials_, &mixed_;
  double accuracy_;
  double longest_ = 0.0;                      // s: largest allowed step
  std::vector<const char*> cheaper_methods_;  // methods other than the default that are tried
  PeakErrors mesh_{}, steps_{};
  PeakErrors halved_{};  // the error of half the step
};

}  // namespace traverse::error_control
