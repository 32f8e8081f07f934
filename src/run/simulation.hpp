// One run of a scene: its motion, and what is evaluated of it. Every run in time is built and computed here. It
// evaluates peaks and diagnostics itself; recorders, checkpoints and displays follow it as observers.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "integrate/stepper.hpp"
#include "run/evaluation.hpp"
#include "run/passage.hpp"

namespace traverse::run {

/// What follows a run in time: recorders, checkpoints, displays. The run itself evaluates peaks and diagnostics.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Collective. At t = 0 and at the end of every step, after the evaluation of this instant.
  virtual void sample(const integrate::Instant& /*instant*/) {}
  /// Collective. At the end of every step, t in s. False: the run stops here, and may be continued.
  virtual bool step(double /*t*/, long /*steps*/) { return true; }
  /// Collective. Before every step, after all calls for earlier steps: the run may be archived.
  virtual void before_step(double /*t*/) {}
};

/// An observer by functions; an empty one does nothing.
class ObserverBy : public Observer {
 public:
  using Sample = std::function<void(const integrate::Instant&)>;
  using Step = std::function<bool(double, long)>;
  explicit ObserverBy(Sample sample, Step step = {}) : sample_(std::move(sample)), step_(std::move(step)) {}
  void sample(const integrate::Instant& instant) override {
    if (sample_) sample_(instant);
  }
  bool step(double t, long steps) override { return !step_ || step_(t, steps); }

 private:
  Sample sample_;
  Step step_;
};

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

  /// Collective, after the last step: the largest static deflection at x (m along the bridge) while the same loads
  /// pass, m; 0 after a signal.
  double static_deflection(double x);
  /// The same at each probe.
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
