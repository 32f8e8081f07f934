// Computes the runs of a sweep or a study on one rank, by the first engine of the table that serves them.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ensemble/case_set.hpp"
#include "ensemble/engines.hpp"
#include "run/shared_beam.hpp"

namespace traverse::ensemble {

/// The indices of runs in batches: neighbours in the order of step group, seed and speed, up to `most` of them.
std::vector<std::vector<std::size_t>> group_runs(const std::vector<CaseRun>& runs, std::size_t most);

class CaseRunner {
 public:
  /// Assembles structure and damping on this rank. The description of the model is appended to `notes`. beam: beam of a
  /// scene that differs in its vehicles and moving forces only; null: a new beam is assembled. checks: the runs of each
  /// train at the slowest and the fastest speed are checked, as they are by default.
  CaseRunner(const scene::Scene& scene, std::vector<std::string>& notes,
             std::shared_ptr<run::SharedBeam> beam = nullptr, bool checks = true);

  const std::vector<double>& speeds() const { return cases_.speeds(); }
  std::size_t trains() const { return cases_.trains(); }
  const std::vector<double>& probes() const { return cases_.scene().output.probes; }
  /// Simulated time, s, used to distribute runs.
  double duration(std::size_t train, double speed) const { return cases_.duration(train, speed); }
  /// Computing time for one second of motion, s, as of the engine.
  double cost() const { return engine_->cost(); }
  /// The estimated computing time of all runs at these speeds, one after another, s.
  double cost_of_all() const;
  /// Computes one run.
  CaseResult run(std::size_t train, const CaseRun& run);
  /// Whether runs are batched; if not, the reason in words.
  bool has_lanes() const { return row_ == batches; }
  const std::string& why_not_in_batches() const { return why_not_[batches]; }
  /// Number of runs in a batch: one, or up to sweep_lanes.
  std::size_t width() const { return engine_->width(); }
  /// A run and the object that computes it.
  struct Member {
    CaseRunner* runner;
    CaseRun run;
  };
  /// Computes the runs of a group, at most `width` with speeds of one step group, of runners that were merged with the
  /// first. `reached` is called with the simulated time, s.
  static std::vector<CaseResult> run_together(std::size_t train, std::span<const Member> members,
                                              const std::function<void(double)>& reached = {});
  /// Whether the greatest peaks of many runs are found without computing all of them.
  bool has_bounds() const { return engine_->has_bounds(); }
  /// The greatest results of the runs of each runner, in the order of the first run of each; all runners have bounds.
  static std::vector<CaseResult> greatest(std::size_t train, std::span<const Member> members);
  /// Makes the runs compatible with the runs of another runner on the same bridge; false if that is not possible.
  bool merge(const CaseRunner& other) { return engine_->merge(*other.engine_); }
  const std::shared_ptr<run::SharedBeam>& beam() const { return cases_.beam(); }
  bool axial() const { return cases_.scene().beam->axial; }
  long separate_runs() const { return engine_->separate_runs(); }  // runs computed outside their batch

 private:
  static constexpr std::size_t batches = 1;  // row of the table
  static std::vector<Engine::Member> by_engines(std::span<const Member> members);
  void hide_unknown(CaseResult& result) const;

  CaseSet cases_;
  std::size_t row_ = 0;
  std::array<std::string, engines.size()> why_not_;  // the reasons against the rows before
  std::unique_ptr<Engine> engine_;
};

}  // namespace traverse::ensemble
