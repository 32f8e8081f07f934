// A run of a bridge by its modes: the exact motion at every stored sample, as nodal vectors of the whole structure.
#pragma once

#include <functional>
#include <vector>

#include "base/archive.hpp"
#include "integrate/modal_motion.hpp"
#include "integrate/stepper.hpp"

namespace traverse::integrate {

class ModalStepper {
 public:
  /// Collective. `system` holds the same beam under the same load, without vehicles.
  ModalStepper(coupling::System& system, const structure::ModalBridge& bridge, structure::BeamOperator& statics,
               const coupling::SystemInput& input, bool equilibrium, double end_time, double interval, long stored = 1);

  /// As Stepper::begin.
  void begin(const std::function<void(const Instant&)>& sample);
  /// As Stepper::run; a step is what lies between two samples. The nodal displacements are those of the modes and, with
  /// K* v = P for what the forces P do to all others, balance P exactly; velocities and accelerations are the modes'.
  double run(const std::function<void(const Instant&)>& sample, const std::function<bool(double, long)>& step,
             const std::function<void(double)>& between = {});
  /// As Stepper::keep.
  void keep(base::Archive& archive);

  long steps() const { return steps_; }
  bool stopped_at_limit() const { return steps_ >= most_steps_; }  // of -ts_max_steps
  std::string method() const;

 private:
  void show_to_monitors();
  void sample_now(const std::function<void(const Instant&)>& sample, Purpose purpose);
  void load_now(double* nodal) const;

  coupling::System& system_;
  const structure::ModalBridge& bridge_;
  structure::BeamOperator& statics_;
  train::MovingLoad load_;
  ForceHistory history_;
  ModalMotion motion_;
  base::Handle<TS> ts_;  // of type modal, which moves it
  PetscInt most_steps_ = 0;
  double most_at_once_ = 0.0;  // s
  double end_time_, interval_;
  long stored_;                                          // one in so many of the samples at the interval is stored
  std::vector<double> sagging_;                          // m, of this rank's unknowns: of the beam's own weight
  std::vector<double> y_, acceleration_, drag_, force_;  // as Instant has them; nodal forces and what they do at rest
  double at_start_ = 0.0;                                // J, in the static correction
  bool dragged_ = false, begun_ = false;
  long steps_ = 0;
};

}  // namespace traverse::integrate
