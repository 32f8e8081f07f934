// Computes the runs of a sweep or a study on one rank. Data that are common to all runs are built once.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/passage_peaks.hpp"
#include "ensemble/case_batch.hpp"
#include "ensemble/moving_force_limits.hpp"
#include "modal_engine/moving_force_batch.hpp"
#include "results/verdict.hpp"
#include "run/shared_beam.hpp"

namespace traverse::app {

class Simulation;

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

/// The indices of runs in batches: neighbours in the order of step group, seed and speed, up to `most` of them.
std::vector<std::vector<std::size_t>> group_runs(const std::vector<CaseRun>& runs, std::size_t most);

class CaseRunner {
 public:
  /// Assembles structure and damping on this rank. The description of the model is appended to `notes`. beam: beam of a
  /// scene that differs in its vehicles and moving forces only; null: a new beam is assembled. checks: the runs of each
  /// train at the slowest and the fastest speed are checked, as they are by default.
  CaseRunner(const Scene& scene, std::vector<std::string>& notes, std::shared_ptr<SharedBeam> beam = nullptr,
             bool checks = true);

  const std::vector<double>& speeds() const { return speeds_; }
  std::size_t trains() const { return loads_.size(); }
  const std::vector<double>& probes() const { return scene_.output.probes; }
  /// Simulated time, s, used to distribute runs.
  double duration(std::size_t train, double speed) const;
  /// Computing time for one second of motion, s: estimated from counts, the same on every rank and machine.
  double cost() const;
  /// The estimated computing time of all runs at these speeds, one after another, s.
  double cost_of_all() const;
  /// Computes one run. `reached` is called with the simulated time, s, after every step.
  CaseResult run(std::size_t train, const CaseRun& run, const std::function<void(double)>& reached = {});
  /// Whether runs are batched; if not, the reason in words.
  bool has_lanes() const { return lanes_ != nullptr; }
  const std::string& lane_obstacle() const { return lane_obstacle_; }
  /// Number of runs in a batch: one, or up to sweep_lanes.
  std::size_t width() const;
  /// A run and the object that computes it.
  struct Member {
    CaseRunner* runner;
    CaseRun run;
  };
  /// Computes the runs of a group, at most `width` with speeds of one step group, of runners that were merged with the
  /// first.
  static std::vector<CaseResult> run_together(std::size_t train, std::span<const Member> members,
                                              const std::function<void(double)>& reached = {});
  /// Whether the greatest peaks of many runs are found without computing all of them.
  bool has_bounds() const {
    return scene_.exact_in_time() && !scene_.has_run_limits() && !beam_->modal->dampers_couple();
  }
  /// The greatest results of the runs of each runner, in the order of the first run of each; all runners have bounds.
  /// Peaks that are not the greatest of all runners, absolutely or relative to the static deflection, may be unknown.
  static std::vector<CaseResult> greatest(std::size_t train, std::span<const Member> members);
  /// Makes the runs compatible with the runs of another runner on the same bridge; false if that is not possible.
  bool merge(const CaseRunner& other) { return lanes_ && other.lanes_ && lanes_->merge(*other.lanes_); }
  const std::shared_ptr<SharedBeam>& beam() const { return beam_; }
  bool axial() const { return scene_.beam->axial; }
  long separate_runs() const { return separate_runs_; }  // runs computed outside their batch

 private:
  /// Sets the parameters of one run in the scene.
  const Scene& scene_of(std::size_t train, const CaseRun& run);
  /// The run of a scene with these parameters; with mechanisms if linear vehicles are not accurate enough.
  CaseResult run_by_elements(const Scene& scene, std::size_t train, const CaseRun& run,
                             const std::function<void(double)>& reached);
  void set_static_deflection(std::size_t train, Simulation& simulation);
  std::vector<CaseResult> run_by_modes(std::size_t train, std::span<const CaseRun> runs);
  const modal_engine::MovingForcePassages& passages_of(std::size_t train);
  void hide_unknown(CaseResult& result) const;
  static std::vector<CaseResult> run_batch(std::size_t train, std::span<const Member> members,
                                           const std::function<void(double)>& reached);
  CaseResult result_of(const engine::BatchResult& batched, std::size_t train) const;
  void set_up_batches();
  void set_up_limits(std::vector<std::string>& notes);
  /// Whether runs are exact in time, and the modes are sufficient for all results.
  bool by_modes_only() const { return scene_.exact_in_time() && (!scene_.has_run_limits() || moving_force_limits_); }

  Scene scene_;
  std::vector<double> speeds_;
  std::vector<MovingLoad> loads_;
  double last_wheel_ = 0.0;  // m: x at t = 0; 0 if all wheels are on the bridge
  std::shared_ptr<SharedBeam> beam_;
  std::map<std::size_t, std::vector<double>> static_deflection_;  // m, for each train
  std::map<std::size_t, modal_engine::MovingForcePassages>
      passages_;                                          // passages of moving forces on modes, for each train
  std::optional<MovingForceLimits> moving_force_limits_;  // only if runs by modes have limits
  std::unique_ptr<CaseBatch> lanes_;
  std::string lane_obstacle_;
  bool by_batch_kernel_ = false;   // runs use the batch kernel, even single ones
  double cutoff_frequency_ = 0.0;  // Hz, of accelerations with a limit; 0: they are not filtered
  long separate_runs_ = 0;
};

}  // namespace traverse::app
