// The choice of what passages in lanes are computed with (batch_model.hpp): a search on their beginnings, checked on
// whole ones.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "error_control/batch_model.hpp"
#include "error_control/batch_search.hpp"
#include "error_control/batch_trial_runs.hpp"

namespace traverse::app {

/// Where trains have their trials: groups of speeds, m/s.
struct TrialSpeeds {
  std::vector<std::vector<double>> beginnings, mixed, wholes;  // mixed: none where the beginnings serve for them
};

class BatchChoice {
 public:
  /// Of a scene with a sweep, which must outlive it.
  BatchChoice(const Scene& scene, const TrialSpeeds& speeds);

  /// Why nothing is chosen; unsettled: a search for less may settle.
  struct NotChosen {
    std::string why;
    bool unsettled = false;
  };
  /// Throws NotChosen, and BatchTrialRuns::Refused where passages cannot go in lanes.
  Choice choose();

 private:
  void take(const std::optional<NumericalModel>& found);
  Scene tried() const;
  /// Whole passages: errors add up while the train crosses. Against a finer mesh and half the step, by esdirk4:
  /// genalpha takes all vibration out of wheels in time, and two of its steps may agree on that.
  PeakErrors check_wholes(BatchSearch& search);
  /// By a finer mesh where it is that what the other one differs by, else by shorter steps.
  void refine(const NumericalModel& other);

  const Scene& scene_;
  Scene fastest_;
  double whole_ = 0.0, distance_ = 0.0;  // m: of a passage, of its beginning
  std::optional<BatchTrialRuns> beginnings_, mixed_, wholes_;
  NumericalModel model_;  // what was chosen
};

/// The errors that a scene asks for, by their names.
std::string words_of(const Scene& scene, const PeakErrors& errors);

}  // namespace traverse::app
