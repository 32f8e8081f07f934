// The engines that compute the runs of a scene, in one table. Each says which runs it serves, or why it does not.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ensemble/case_set.hpp"

namespace traverse::ensemble {

class Engine {
 public:
  virtual ~Engine() = default;
  /// A run and the engine of its scene. All members of a call have engines of the same row, merged with the first.
  struct Member {
    Engine* engine;
    CaseRun run;
  };
  /// Computes at most `width` runs, whose speeds are of one step group. `reached`, which may be empty, is called with
  /// the simulated time, s.
  virtual std::vector<CaseResult> run(std::size_t train, std::span<const Member> members,
                                      const std::function<void(double)>& reached) = 0;
  /// Number of runs that are computed together.
  virtual std::size_t width() const { return 1; }
  /// Computing time for one second of motion, s: estimated from counts, the same on every rank and machine. NaN if each
  /// run chooses its step.
  virtual double cost() const = 0;
  /// Makes the runs compatible with those of another engine of the same row; false if that is not possible.
  virtual bool merge(const Engine& /*other*/) { return false; }
  /// Whether the greatest peaks of many runs are found without computing all of them.
  virtual bool has_bounds() const { return false; }
  /// The greatest results of the runs of each engine, in the order of the first run of each; all engines have bounds.
  /// Peaks that are not the greatest of all, absolutely or relative to the static deflection, may be unknown.
  virtual std::vector<CaseResult> greatest(std::size_t /*train*/, std::span<const Member> /*members*/) { return {}; }
  virtual long separate_runs() const { return 0; }  // computed outside their batch
};

/// Each returns null and sets the reason in words if it does not serve the cases.
std::unique_ptr<Engine> modal_engine_for(CaseSet& cases, std::string& why);
std::unique_ptr<Engine> batch_engine_for(CaseSet& cases, std::string& why);
std::unique_ptr<Engine> single_engine_for(CaseSet& cases, std::string& why);

struct EngineRow {
  const char* name;
  std::unique_ptr<Engine> (*serve)(CaseSet& cases, std::string& why);
};
/// From the cheapest on; the last one serves all cases.
inline constexpr std::array engines = {EngineRow{"modes, exact in time", modal_engine_for},
                                       EngineRow{"batches by elements or modes", batch_engine_for},
                                       EngineRow{"one by one", single_engine_for}};

}  // namespace traverse::ensemble
