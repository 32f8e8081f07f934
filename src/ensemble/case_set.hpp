// The runs of one scene: with its speeds, force trains and tracks, on one beam that is assembled once.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/passage_peaks.hpp"
#include "results/verdict.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::ensemble {

/// Results of a run.
struct CaseResult : base::PassagePeaks {
  std::vector<double> static_deflection;              // m, at each probe; 0: unknown
  bool outside_trials = false;                        // a contact loss or event that no trial run covered
  std::vector<results::EvaluatedQuantity> evaluated;  // for each limit of the scene; empty: not evaluated
  bool ended = false;                                 // false: ended by a signal
};

/// Parameters of one run, besides its force train.
struct CaseRun {
  double speed = 0.0;                 // m/s
  std::optional<std::uint64_t> seed;  // seed of its track; none: the scene's track
  double step_speed = 0.0;            // m/s: the run has the steps of this speed; 0: of its own

  double speed_of_steps() const { return step_speed > 0.0 ? step_speed : speed; }
};

class CaseSet {
 public:
  /// Assembles structure and damping on this rank, unless `beam` is that of a scene that differs in its vehicles and
  /// moving forces only. The description of the model is appended to `notes`.
  CaseSet(const scene::Scene& scene, std::vector<std::string>& notes, std::shared_ptr<run::SharedBeam> beam);

  /// The scene as it is now.
  const scene::Scene& scene() const { return scene_; }
  /// The scene with the parameters of one run.
  const scene::Scene& of(std::size_t train, const CaseRun& run);
  const std::vector<double>& speeds() const { return speeds_; }
  std::size_t trains() const { return loads_.size(); }
  /// Simulated time of a run, s.
  double duration(std::size_t train, double speed) const;
  run::SharedBeam& shared() const { return *beam_; }
  const std::shared_ptr<run::SharedBeam>& beam() const { return beam_; }
  double cutoff_frequency() const { return cutoff_frequency_; }  // Hz, of accelerations with a limit; 0: not filtered
  // Computing times for one second of motion, s, of a run by modes and of one in a batch.
  double seconds_by_modes() const;
  double seconds_in_batches() const;
  bool dampers_couple_modes() const { return beam_->modal->dampers_couple(); }

 private:
  scene::Scene scene_;
  std::vector<double> speeds_;
  std::vector<train::MovingLoad> loads_;
  double last_wheel_ = 0.0;  // m: x at t = 0; 0 if all wheels are on the bridge
  std::shared_ptr<run::SharedBeam> beam_;
  double cutoff_frequency_ = 0.0;
};

}  // namespace traverse::ensemble
