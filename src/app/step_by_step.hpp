// A scene whose motion another program advances from sample to sample, with forces that it may set between samples.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "prepare.hpp"
#include "run/outputs.hpp"
#include "run/simulation.hpp"

namespace traverse::app {

/// Runs on this process alone. The time steps are equal to the steps of `run` for the same scene. The results are equal
/// too if no force is set.
class StepByStep : private Observer {
 public:
  /// Sets up the state at t = 0. Throws Error like `run`, and InputError for a scene without motion in time.
  explicit StepByStep(const Scene& scene);

  double time() const { return time_; }  // s, time of the present sample
  double end() const { return simulation_->plan().end_time; }
  double interval() const;  // s between samples

  /// Advances to the first sample at or after t, s; does nothing if it is already reached. Throws InputError if t is
  /// after the end of the scene, and SolverError if a time step cannot be solved: then the run cannot be continued.
  void advance(double t);

  /// The datasets that the results file of the scene would have, and their values at the present sample.
  const results::Layout& layout() const { return outputs_->layout(); }
  const std::vector<double>& values() const { return values_; }

  /// Sets a force that is constant from now on: (N, N, N m) on a body of a vehicle, numbered as in the train, or a
  /// vertical force (N, upward) on the beam at a station x (m). It replaces the previous force there. Throws InputError
  /// if the body or the station does not exist, and for a model that does not admit such forces.
  void apply_to_body(int vehicle, const std::string& body, const Eigen::Vector3d& action);
  void apply_to_beam(double x, double force);

 private:
  static Scene chosen(Scene scene, Accuracy& accuracy, std::vector<std::string>& notes);
  void sample(const integrate::Instant& instant) override;
  bool step(double t, long steps) override;
  void check_takes_forces();

  std::vector<std::string> notes_;
  Accuracy accuracy_;
  Scene scene_;
  SharedBeam shared_;
  std::optional<Simulation> simulation_;
  std::optional<Outputs> outputs_;
  double time_ = 0.0, wanted_ = 0.0;  // s: the present sample; the end of the steps under way
  std::vector<double> values_;
  bool failed_ = false;
};

}  // namespace traverse::app
