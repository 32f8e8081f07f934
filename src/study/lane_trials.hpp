// Trial passages side by side, by several models: what modes, meshes, methods and steps change.
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

#include "run/peaks.hpp"
#include "study/side_by_side.hpp"

namespace traverse::app {

/// What the runs are computed with.
struct LaneModel {
  int modes = 0, elements = 0;
  const structure::MethodRow* method = nullptr;
  double step = 0.0;  // s
  bool operator==(const LaneModel&) const = default;
};

/// The scene by such a model, with linear vehicles.
Scene with(const Scene& given, const LaneModel& model);

/// Errors of each quantity's peaks.
using LaneErrors = std::array<double, quantities>;

/// The largest differences of the peaks of runs, of the scene's accuracy_of, relative to the largest of their kind in
/// the run; 1 where one of them has found no end. Runs in which wheels lose contact both times are passed over.
LaneErrors difference(const Scene& scene, const std::vector<lanes::CrossingResult>& a,
                      const std::vector<lanes::CrossingResult>& b);
double greatest(const LaneErrors& errors);
bool lose_contact(const std::vector<lanes::CrossingResult>& runs);

/// Passages of one scene at some speeds.
class LaneTrials {
 public:
  /// Groups of speeds, those of a group in one class, or the slowest one first; distance: of every passage, m. A group
  /// of one speed goes over the tracks of the scene's sweep too, its own track last, as many as there are lanes.
  /// before: trials whose modes serve for these too, where the bridge is the same; it must outlive these.
  LaneTrials(Scene scene, const std::vector<std::vector<double>>& speeds, double distance,
             const LaneTrials* before = nullptr);

  /// Kept. Refused where runs cannot go side by side.
  const std::vector<lanes::CrossingResult>& run(const LaneModel& model);
  /// Those of several models that are not known yet, each in a thread of its own.
  void run_at_once(std::span<const LaneModel> models);
  /// Of the bridge by a model: with all copies of the last frequency.
  int modes(const LaneModel& model) { return static_cast<int>(setup(model).shared->modal->modes()); }
  // rad/s
  double first_omega(const LaneModel& model) { return setup(model).shared->modal->omega().front(); }
  double last_omega(const LaneModel& model) { return setup(model).shared->modal->omega().back(); }
  /// The largest SideBySide::defect of a model's runs, which are known.
  double defect(const LaneModel& model) const;
  const Scene& scene() const { return scene_; }

  struct Refused {
    std::string why;
  };

 private:
  struct Setup {
    Scene scene;
    std::optional<SharedBeam> shared;
    std::optional<SideBySide> lanes;
  };
  struct Kept {
    LaneModel model;
    std::vector<lanes::CrossingResult> results;
    double defect = 0.0;
  };
  const Kept* known(const LaneModel& model) const;
  void check_memory(const LaneModel& model) const;
  SideBySide::Steps steps_of(const LaneModel& model) const;
  std::vector<lanes::CrossingResult> run_all(const std::vector<SideBySide::Ready>& groups,
                                             const SideBySide::Steps& steps) const;
  Setup& setup(const LaneModel& model);
  const modes::Basis* basis_with(const LaneModel& model) const;
  /// That of the first mesh, for all of them.
  std::optional<beam::Rayleigh> damping() const {
    return !damping_ && before_ != nullptr ? before_->damping_ : damping_;
  }

  Scene scene_;
  const LaneTrials* before_;
  std::vector<std::vector<LaneRun>> groups_;
  std::map<std::pair<int, int>, std::unique_ptr<Setup>> setups_;  // by modes and elements
  std::deque<Kept> kept_;                                         // references to its entries stay
  std::optional<beam::Rayleigh> damping_;
};

}  // namespace traverse::app
