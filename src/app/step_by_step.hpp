// A scene that somebody else's program takes through time: from sample to sample, with forces set in between.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "prepare.hpp"
#include "results/recorder.hpp"
#include "run/outputs.hpp"
#include "run/passage.hpp"
#include "run/run_observer.hpp"

namespace traverse::app {

/// On this process alone. Steps, and with no force set results, are those that `run` has of the same scene.
class StepByStep {
 public:
  /// Stands at t = 0 then. Throws Error as `run` does, and InputError for a scene that is no motion in time.
  explicit StepByStep(const Scene& scene);

  double time() const { return time_; }  // s, of the sample that was reached
  double end() const { return passage_->plan().end_time; }
  double interval() const;  // s between samples

  /// Goes to the first sample that is not before t, s; nowhere where that one has been reached. InputError beyond the
  /// end of the scene, SolverError where a step cannot be taken: then the passage is over.
  void advance(double t);

  /// What the results file of the scene would hold, and a row of it at the sample that was reached.
  const results::Layout& layout() const { return outputs_->layout(); }
  const std::vector<double>& values() const { return values_; }

  /// From here on a constant force (N, N, N m) on a body of a vehicle, numbered as in the train, or a vertical one (N,
  /// upward) on the beam at a station x (m), in place of the last one there. InputError for what is not there, and for
  /// a model that takes no such forces.
  void apply_to_body(int vehicle, const std::string& body, const Eigen::Vector3d& action);
  void apply_to_beam(double x, double force);

 private:
  static Scene chosen(Scene scene, Accuracy& accuracy, std::vector<std::string>& notes);
  void see(const integrate::Instant& instant);
  void check_takes_forces() const;

  std::vector<std::string> notes_;
  Accuracy accuracy_;
  Scene scene_;
  SharedBeam shared_;
  results::Recorder recorder_;  // of nothing
  std::optional<Passage> passage_;
  std::optional<Outputs> outputs_;
  std::optional<RunObserver> watch_;
  double time_ = 0.0;
  std::vector<double> values_;
  bool failed_ = false;
};

}  // namespace traverse::app
