// The runs of a sweep or a study as one rank computes them. What does not change from run to run is built once.
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
#include "run/passage.hpp"

namespace traverse::app {

/// What is left of a run.
struct CaseResult : base::PassagePeaks {
  std::vector<double> static_deflection;  // m, of each probe; 0: unknown
  bool unseen = false;                    // it has met what no trial run has seen, or was not taken as these were
  std::vector<results::EvaluatedQuantity> findings;  // of each limit of the scene; none where no run is judged
  bool ended = false;                                // false: a signal came first
};

/// What is one run's own, besides its train of forces.
struct CaseRun {
  double speed = 0.0;                 // m/s
  std::optional<std::uint64_t> seed;  // of its track; none: the scene's own
};

/// The indices of runs that go together: neighbours in the order of class of speed, seed and speed, up to `most` of
/// them.
std::vector<std::vector<std::size_t>> group_runs(const std::vector<CaseRun>& runs, std::size_t most);

class CaseRunner {
 public:
  /// Builds structure and damping on this rank alone, and checks the runs at the slowest and the fastest speed. What
  /// was modelled goes into `notes`.
  /// beam: of a scene that differs in its vehicles alone; null: it builds its own.
  CaseRunner(const Scene& scene, std::vector<std::string>& notes, std::shared_ptr<SharedBeam> beam = nullptr);

  const std::vector<double>& speeds() const { return speeds_; }
  std::size_t trains() const { return loads_.size(); }
  const std::vector<double>& probes() const { return scene_.output.probes; }
  /// s from the start to the end, by which runs are dealt.
  double duration(std::size_t train, double speed) const;
  /// What a second of motion takes, s: estimated by counting, the same on every rank and machine.
  double cost() const;
  /// What all runs at these speeds take one after another, s, by that estimate.
  double cost_of_all() const;
  /// One run. `reached` hears the time of its motion, s, after every step.
  CaseResult run(std::size_t train, const CaseRun& run, const std::function<void(double)>& reached = {});
  /// Whether runs go side by side; why not, in words.
  bool has_lanes() const { return lanes_.has_value(); }
  const std::string& why_no_lanes() const { return why_no_lanes_; }
  /// How many runs go together: one, or up to sweep_lanes.
  std::size_t width() const;
  /// A run, and what computes it.
  struct Member {
    CaseRunner* runner;
    CaseRun run;
  };
  /// Runs of a group, at most `width` with speeds of one class, of runners that go beside the first.
  static std::vector<CaseResult> run_together(std::size_t train, std::span<const Member> members,
                                              const std::function<void(double)>& reached = {});
  /// From now on its runs go beside those of another runner on the same bridge; false where they cannot.
  bool merge(const CaseRunner& other) { return lanes_ && other.lanes_ && lanes_->merge(*other.lanes_); }
  const std::shared_ptr<SharedBeam>& beam() const { return beam_; }
  bool axial() const { return scene_.beam->axial; }
  long alone() const { return alone_; }  // runs that had to leave their group

 private:
  /// The scene of one run.
  const Scene& scene_of(std::size_t train, const CaseRun& run);
  CaseResult run_by_elements(std::size_t train, const CaseRun& run, const std::function<void(double)>& reached);
  CaseResult run_with_mechanisms(std::size_t train, const CaseRun& run, const std::function<void(double)>& reached);
  std::vector<CaseResult> run_by_modes(std::size_t train, std::span<const CaseRun> runs);
  static std::vector<CaseResult> run_in_lanes(std::size_t train, std::span<const Member> members,
                                              const std::function<void(double)>& reached);
  CaseResult result_of(const engine::BatchResult& crossing, std::size_t train) const;
  void set_up_lanes();
  void set_up_limits(std::vector<std::string>& notes);
  /// Whether runs are exact in time, and their modes tell all that is asked.
  bool by_modes_alone() const { return scene_.exact_in_time() && (!scene_.judges_runs() || force_findings_); }

  Scene scene_;
  std::vector<double> speeds_;
  std::vector<MovingLoad> loads_;
  double last_wheel_ = 0.0;  // m: x at t = 0; 0 where all wheels stand on the bridge
  std::shared_ptr<SharedBeam> beam_;
  std::map<std::size_t, std::vector<double>> static_deflection_;       // of each train
  std::map<std::size_t, modal_engine::MovingForcePassages> passages_;  // of moving forces by modes
  std::optional<MovingForceLimits> force_findings_;                    // where limits are set to such runs
  std::optional<CaseBatch> lanes_;
  std::string why_no_lanes_;
  bool by_kernel_ = false;  // of the lanes, be it alone
  double counting_ = 0.0;   // Hz, up to which limits count accelerations; 0: they are not filtered
  long alone_ = 0;
};

}  // namespace traverse::app
