// Batched trial runs of a train over the bridge (passages) with several numerical models.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ensemble/case_batch.hpp"
#include "error_control/model_choice.hpp"
#include "error_control/peak_errors.hpp"
#include "run/response_extremes.hpp"

namespace traverse::error_control {

/// The largest differences of all runs; 1 if one of them has failed.
PeakErrors difference(const scene::Scene& scene, const std::vector<engine::BatchResult>& rough,
                      const std::vector<engine::BatchResult>& fine);
bool any_contact_loss(const std::vector<engine::BatchResult>& runs);

/// Passages of one scene at some speeds.
class BatchTrialRuns {
 public:
  /// speeds: groups of runs; the speeds of a group are in one step group, or the slowest is first. distance: length of
  /// every passage, m. A group of one speed also runs over the tracks of the scene's sweep, as many as there are lanes,
  /// with its own track last.
  BatchTrialRuns(scene::Scene scene, const std::vector<std::vector<double>>& speeds, double distance);

  /// The results of a model's runs, which are stored. Each group has its own thread. Throws Refused if the runs cannot
  /// be computed in batches.
  const std::vector<engine::BatchResult>& run(const scene::NumericalModel& model);
  /// The first frequency of the bridge, rad/s, with the mesh of this model or an earlier one.
  double first_omega(const scene::NumericalModel& model) {
    setup(model);
    return first_omega_;
  }
  /// The largest CaseBatch::residual of a model's stored runs.
  double residual(const scene::NumericalModel& model) const;
  const scene::Scene& scene() const { return scene_; }

  struct Refused {
    std::string why;
  };

 private:
  struct Setup {
    scene::Scene scene;
    std::optional<run::SharedBeam> shared;
    std::unique_ptr<ensemble::CaseBatch> lanes;
  };
  struct StoredRuns {
    scene::NumericalModel model;
    std::vector<engine::BatchResult> results;
    double residual = 0.0;
  };
  const StoredRuns* find(const scene::NumericalModel& model) const;
  void check_memory(const scene::NumericalModel& model) const;
  ensemble::CaseBatch::Steps steps_of(const scene::NumericalModel& model) const;
  std::vector<engine::BatchResult> run_group(const ensemble::CaseBatch::Ready& ready,
                                             const std::vector<ensemble::LaneRun>& runs,
                                             const ensemble::CaseBatch::Steps& steps) const;
  Setup& setup(const scene::NumericalModel& model);

  scene::Scene scene_;
  std::vector<std::vector<ensemble::LaneRun>> groups_;
  std::map<int, std::unique_ptr<Setup>> setups_;  // the key is the number of elements
  std::deque<StoredRuns> stored_;                 // a deque, because references to entries must remain valid
  std::optional<beam::Rayleigh> damping_;         // of the first mesh, used for all meshes
  double first_omega_ = 0.0;
};

}  // namespace traverse::error_control
