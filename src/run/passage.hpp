// One transient run of a scene, or its static response: checked when it is built, computed by `run`.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integrate/modal_stepper.hpp"
#include "integrate/stepper.hpp"
#include "run/plan.hpp"
#include "run/shared_beam.hpp"

namespace traverse::run {

/// The vehicles and loads of a scene. static_only: they do not move.
coupling::SystemInput system_input(const scene::Scene& scene, bool static_only);

/// The bridge by modes if vehicles run on its modes, otherwise by elements; null without a bridge.
std::unique_ptr<structure::MovingStructure> carrier(const scene::Scene& scene, const SharedBeam& shared,
                                                    const coupling::SystemInput& input);

/// On a rank that has been called by WaitingRanks: takes part in the run of a scene, which has its model.
void serve_trains(MPI_Comm comm, const scene::Scene& scene);

class Passage {
 public:
  /// Collective. InputError if the scene cannot be run. Scene and structure must outlive this object. earlier: the plan
  /// of the run that this one continues, with its steps and samples; null: none.
  Passage(const scene::Scene& scene, const SharedBeam& shared, std::vector<std::string>& notes,
          const Plan* earlier = nullptr);

  /// Collective. Sets the initial state; SolverError if there is no equilibrium.
  void start(std::vector<std::string>& notes);
  /// See Stepper::begin.
  void begin(const std::function<void(const integrate::Instant&)>& sample) {
    stepper_ ? stepper_->begin(sample) : modal_->begin(sample);
  }
  /// After start, of a system that shares its trains: System::serve.
  void serve() { stepper_->serve(); }
  /// See Stepper::run.
  void run(const std::function<void(const integrate::Instant&)>& sample, const std::function<bool(double, long)>& step,
           const std::function<void(double)>& between = {});

  /// Collective. Writes the state between two steps, or reads it after the start.
  void keep(base::Archive& archive);
  /// The reason why the state cannot be written; empty: it can.
  std::string no_archive() const { return stepper_ ? stepper_->no_archive() : ""; }

  coupling::System& system() { return system_; }
  bool exact_in_time() const { return modal_.has_value(); }
  const Plan& plan() const { return plan_; }
  long rejected() const { return stepper_ ? stepper_->rejected() : 0; }
  long steps() const { return stepper_ ? stepper_->steps() : modal_->steps(); }
  /// See Stepper::count_steps.
  integrate::StepCount count_steps(double end, double step, double interval) {
    return stepper_->count_steps(end, step, interval);
  }
  /// The instants of a step of a run that is exact in time.
  double instants() const { return modal_->instants(); }
  bool stopped_at_limit() const { return stepper_ ? stepper_->stopped_at_limit() : modal_->stopped_at_limit(); }

 private:
  void add_axle_passages(std::vector<double>& times) const;
  void limit_to_active_window(std::vector<std::string>& notes);

  const scene::Scene& scene_;
  const SharedBeam& shared_;
  bool static_only_;
  coupling::SystemInput input_;
  coupling::System system_;
  Plan plan_{0.0, 1.0, 1.0};
  std::optional<integrate::Stepper> stepper_;  // a run has one of the two steppers
  std::optional<integrate::ModalStepper> modal_;
};

}  // namespace traverse::run
