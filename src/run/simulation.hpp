// One run of a scene: its motion, and what is evaluated of it. Every run in time is built and computed here.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "run/evaluation.hpp"
#include "run/observer.hpp"
#include "run/passage.hpp"

namespace traverse::run {

class Simulation {
 public:
  /// Collective. Brings the run to its start: in static equilibrium, or undeflected. Throws like Passage. Scene and
  /// structure must outlive this object. earlier: as for Passage.
  Simulation(const scene::Scene& scene, const SharedBeam& shared, const Wants& wants, std::vector<std::string>& notes,
             const Plan* earlier = nullptr);

  using Observers = std::initializer_list<Observer*>;
  /// Collective. Evaluates t = 0, if that has not been done; run() does it too.
  void begin(Observers observers);
  /// Collective. Computes the motion to its end, or until an observer stops it; it can be called again then. Throws
  /// SolverError like Stepper::run.
  void run(Observers observers);
  /// Collective. After the last step, once.
  Result result();

  /// After the last step: the largest static deflection at each probe while the same loads pass, m; 0 after a signal.
  std::vector<double> static_deflections();

  /// Collective. Writes the state between two steps, or reads it after the start.
  void keep(base::Archive& archive);

  Passage& passage() { return passage_; }
  coupling::System& system() { return passage_.system(); }
  const Plan& plan() const { return passage_.plan(); }
  Evaluation& evaluation() { return *evaluation_; }

 private:
  void sample(const integrate::Instant& instant, Observers observers);

  MPI_Comm comm_;
  const scene::Scene& scene_;
  Passage passage_;
  std::optional<Evaluation> evaluation_;  // there after the start
};

}  // namespace traverse::run
