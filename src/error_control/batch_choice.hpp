// Chooses the model of batched runs of a train over the bridge (passages, batch_model.hpp): by a search on the first
// part of passages and a check on whole passages.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "error_control/batch_model.hpp"
#include "error_control/batch_search.hpp"
#include "error_control/batch_trial_runs.hpp"

namespace traverse::error_control {

/// Speeds of the trial passages in groups, m/s.
struct TrialSpeeds {
  std::vector<std::vector<double>> first_parts, mixed, whole_passages;  // mixed: empty if first_parts are used instead
};

class BatchChoice {
 public:
  /// The scene must have a sweep and must outlive this object.
  BatchChoice(const scene::Scene& scene, const TrialSpeeds& speeds);

  /// The reason why nothing was chosen. not_converged: a search with a smaller accuracy may succeed.
  struct NotChosen {
    std::string why;
    bool not_converged = false;
  };
  /// Throws NotChosen, and BatchTrialRuns::Refused if passages cannot be computed in batches.
  Choice choose();

 private:
  void accept(const std::optional<scene::NumericalModel>& model);
  scene::Scene trial_scene() const;
  /// Compares whole passages, because errors accumulate while the train crosses, with a finer mesh and half the step by
  /// esdirk4. genalpha damps the vibration of wheels completely in time, and two of its steps may agree on that.
  PeakErrors check_wholes(BatchSearch& search);
  /// Refines the mesh if it causes the difference to `other`, otherwise the step.
  void refine(const scene::NumericalModel& other);

  const scene::Scene& scene_;
  scene::Scene fastest_;
  double passage_length_ = 0.0, distance_ = 0.0;  // length of a whole passage, and of its first part, m
  std::optional<BatchTrialRuns> first_parts_, mixed_, whole_passages_;
  scene::NumericalModel model_;  // the choice
};

/// The errors of the controlled quantities with their names.
std::string text_of(const scene::Scene& scene, const PeakErrors& errors);

}  // namespace traverse::error_control
