// Searches mesh, method and step of batched runs.
#pragma once

#include <optional>
#include <vector>

#include "error_control/batch_trial_runs.hpp"

namespace traverse::app {

class BatchSearch {
 public:
  /// mixed: the same passages at slow and fast speeds in one group with the steps of the slowest, which reveal further
  /// errors of the mesh. accuracy: limit of the total error.
  BatchSearch(BatchTrialRuns& trials, BatchTrialRuns& mixed, double accuracy)
      : trials_(trials), mixed_(mixed), accuracy_(accuracy) {}

  /// The initial model for passages of `duration`, s.
  NumericalModel first(double duration);
  /// The cheapest model within the accuracy; empty: none.
  std::optional<NumericalModel> run(NumericalModel model);
  double error_of_mesh(std::size_t q) const { return mesh_[q]; }
  double error_of_steps(std::size_t q) const { return steps_[q]; }
  /// The mesh of comparison, with twice the elements.
  NumericalModel on_finer_mesh(NumericalModel model) const;

 private:
  bool predict_step(NumericalModel& model);
  bool halve_step(NumericalModel& model);
  void measure_steps(const NumericalModel& model);
  bool refine_mesh(NumericalModel& model);
  NumericalModel find_cheaper(const NumericalModel& model);
  PeakErrors errors_of(const NumericalModel& candidate, const NumericalModel& model);
  double error_ratio(const PeakErrors& errors) const;

  BatchTrialRuns &trials_, &mixed_;
  double accuracy_;
  double longest_ = 0.0;                      // s: largest allowed step
  std::vector<const char*> cheaper_methods_;  // methods other than the default that are tried
  PeakErrors mesh_{}, steps_{};
  PeakErrors halved_{};  // the error of half the step
};

}  // namespace traverse::app
