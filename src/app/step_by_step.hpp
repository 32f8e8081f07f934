// A scene whose motion another program advances from sample to sample, with forces that it may set between samples.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prepare.hpp"
#include "run/outputs.hpp"
#include "run/simulation.hpp"
#include "traverse/simulate.hpp"

namespace traverse::app {

/// A scene with the model that was chosen for it on this process.
struct ChosenScene {
  scene::Scene scene;
  error_control::Accuracy accuracy;
};
/// Throws Error like `run`, and InputError for a scene without motion in time.
ChosenScene choose_for_one_run(scene::Scene scene);

/// Runs on this process alone. The time steps are equal to the steps of `run` for the same scene. The results are equal
/// too if no force is set.
class StepByStep : public Instant, private run::Observer {
 public:
  /// Sets up the state at t = 0. Throws Error like `run`.
  explicit StepByStep(ChosenScene chosen);

  double time() const override { return time_; }  // s, time of the present sample
  double end() const override { return simulation_->plan().end_time; }
  double interval() const;  // s between samples

  /// Advances to the first sample at or after t, s; does nothing if it is already reached. Throws InputError if t is
  /// after the end of the scene, and SolverError if a time step cannot be solved: then the run cannot be continued.
  void advance(double t);

  /// The datasets that the results file of the scene would have, and their values at the present sample.
  const results::Layout& layout() const { return outputs_->layout(); }
  const std::vector<double>& values() const { return values_; }

  std::span<const double> read(const std::string& dataset) const override;
  /// The force replaces the previous one there. Throws InputError if the body or the station does not exist, and for a
  /// model that does not admit such forces.
  void set_body_force(int vehicle, const std::string& body, const std::array<double, 3>& force) override;
  void set_beam_force(double x, double force) override;

  /// After the last sample, once. SolverError if the energies show that the motion is invalid.
  traverse::Result result();
  double step_length() const { return simulation_->plan().time_step; }  // s, of the longest step

 private:
  void sample(const integrate::Instant& instant) override;
  bool step(double t, long steps) override;
  void check_takes_forces();

  std::vector<std::string> notes_;
  scene::Scene scene_;
  run::SharedBeam shared_;
  std::optional<run::Simulation> simulation_;
  std::optional<run::Outputs> outputs_;
  double time_ = 0.0, wanted_ = 0.0;  // s: the present sample; the end of the steps under way
  std::vector<double> values_;
  bool failed_ = false;
};

}  // namespace traverse::app
