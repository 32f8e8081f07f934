// Trial passages side by side, by several models: what meshes, methods and steps change.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ensemble/case_batch.hpp"
#include "error_control/model_choice.hpp"
#include "error_control/peak_errors.hpp"
#include "run/response_extremes.hpp"

namespace traverse::app {

/// The largest of all runs; 1 where one of them has found no end.
PeakErrors difference(const Scene& scene, const std::vector<engine::BatchResult>& rough,
                      const std::vector<engine::BatchResult>& fine);
bool lose_contact(const std::vector<engine::BatchResult>& runs);

/// Passages of one scene at some speeds.
class BatchTrialRuns {
 public:
  /// Groups of speeds, those of a group in one class, or the slowest one first; distance: of every passage, m. A group
  /// of one speed goes over the tracks of the scene's sweep too, its own track last, as many as there are lanes.
  /// before: trials whose damping serves for these too, where the bridge is the same; it must outlive these.
  BatchTrialRuns(Scene scene, const std::vector<std::vector<double>>& speeds, double distance,
                 const BatchTrialRuns* before = nullptr);

  /// Kept. Refused where runs cannot go side by side.
  const std::vector<engine::BatchResult>& run(const NumericalModel& model);
  /// Those of several models that are not known yet, each in a thread of its own.
  void run_at_once(std::span<const NumericalModel> models);
  /// rad/s, of the bridge by that model or another one.
  double first_omega(const NumericalModel& model) {
    setup(model);
    return first_omega_;
  }
  /// The largest CaseBatch::defect of a model's runs, which are known.
  double defect(const NumericalModel& model) const;
  const Scene& scene() const { return scene_; }

  struct Refused {
    std::string why;
  };

 private:
  struct Setup {
    Scene scene;
    std::optional<SharedBeam> shared;
    std::optional<CaseBatch> lanes;
  };
  struct Kept {
    NumericalModel model;
    std::vector<engine::BatchResult> results;
    double defect = 0.0;
  };
  const Kept* known(const NumericalModel& model) const;
  void check_memory(const NumericalModel& model) const;
  CaseBatch::Steps steps_of(const NumericalModel& model) const;
  std::vector<engine::BatchResult> run_all(const std::vector<CaseBatch::Ready>& groups,
                                           const CaseBatch::Steps& steps) const;
  Setup& setup(const NumericalModel& model);
  /// That of the first mesh, for all of them.
  std::optional<beam::Rayleigh> damping() const {
    return !damping_ && before_ != nullptr ? before_->damping_ : damping_;
  }

  Scene scene_;
  const BatchTrialRuns* before_;
  std::vector<std::vector<LaneRun>> groups_;
  std::map<int, std::unique_ptr<Setup>> setups_;  // by elements
  std::deque<Kept> kept_;                         // references to its entries stay
  std::optional<beam::Rayleigh> damping_;
  double first_omega_ = 0.0;
};

}  // namespace traverse::app
