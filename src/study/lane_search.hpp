// The search for modes, mesh, method and step of runs by the lanes' kernel.
#pragma once

#include <map>
#include <optional>

#include "study/lane_trials.hpp"

namespace traverse::app {

/// Times what half as many modes more change: the most that errors are which fall with the square or faster.
inline constexpr double of_the_change = 1.8;

class LaneSearch {
 public:
  /// mixed: the same passages at slow and fast speeds in one group, whose steps are those of the slowest: what modes
  /// and mesh change is seen there as well. accuracy: the error that all of it may leave.
  LaneSearch(LaneTrials& trials, LaneTrials& mixed, double accuracy, int most_modes)
      : trials_(trials), mixed_(mixed), accuracy_(accuracy), most_modes_(most_modes) {}

  /// The model that the search begins with, for passages that last so long, s.
  LaneModel first(double duration);
  /// The cheapest model within the accuracy; empty: none.
  std::optional<LaneModel> run(LaneModel model);
  /// The same with this number of modes, by steps of esdirk4 that begin with this one.
  std::optional<LaneModel> with_steps(LaneModel model);
  /// Of modes and mesh, and of the steps.
  double error_of_model(std::size_t q) const { return modes_[q] + mesh_[q]; }
  double error_of_steps(std::size_t q) const { return steps_[q]; }
  /// What the number of modes of a model is compared with: half as many modes more, on a mesh that resolves them.
  LaneModel with_more_modes(const LaneModel& model);

 private:
  bool foresee_step(LaneModel& model);
  bool halve_step(LaneModel& model);
  void measure_steps(const LaneModel& model);
  bool add_modes(LaneModel& model);
  LaneErrors left_out(const LaneModel& model, const LaneModel& more);
  void mind_slow_orders(int modes);
  void foresee(const LaneModel& model);
  LaneModel on_coarser_mesh(LaneModel model) const;
  bool refine_mesh(LaneModel& model);
  LaneModel cheaper(const LaneModel& model);
  LaneErrors left_by(const LaneModel& tried, const LaneModel& model);
  double over(const LaneErrors& errors) const;

  LaneTrials &trials_, &mixed_;
  double accuracy_;
  int most_modes_;
  double longest_ = 0.0;    // s: no step is longer
  bool one_solve_ = false;  // methods of one solve a step are tried
  LaneErrors modes_{}, steps_{}, mesh_{};
  LaneErrors halved_{};                // what half the step leaves
  std::map<int, LaneErrors> changes_;  // by the number of modes: what these leave if errors fall with supposed_order
};

}  // namespace traverse::app
