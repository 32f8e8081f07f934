// A run of a bridge by modes: the exact motion at every sample, as nodal vectors of the whole structure.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <vector>

#include "base/archive.hpp"
#include "integrate/modal_motion.hpp"
#include "integrate/stepper.hpp"

namespace traverse::integrate {

class ModalStepper {
 public:
  /// Collective. `system` has the same beam under the same load, without vehicles.
  ModalStepper(coupling::System& system, const structure::ModalBridge& bridge, structure::BeamOperator& statics,
               const coupling::SystemInput& input, bool equilibrium, double end_time, double interval, long stored = 1);

  /// Like Stepper::begin.
  void begin(const std::function<void(const Instant&)>& sample);
  /// Like Stepper::run; a step is the interval between two samples, which has further instants for peaks where the
  /// fastest mode needs them. The nodal displacements are the displacements by
  /// the modes plus the static deflections of all other modes, so that K* v balances the forces P exactly. Velocities
  /// and accelerations are by the modes only.
  double run(const std::function<void(const Instant&)>& sample, const std::function<bool(double, long)>& step,
             const std::function<void(double)>& between = {});
  /// Like Stepper::keep.
  void keep(base::Archive& archive);

  long steps() const { return steps_; }
  /// The instants of a step, the sample at its end included.
  double instants() const { return std::ceil(interval_ / longest_step_); }
  bool stopped_at_limit() const { return steps_ >= most_steps_; }  // limit -ts_max_steps
  std::string method() const;

 private:
  void call_monitors();
  void advance(double t);
  void sample_now(const std::function<void(const Instant&)>& sample, Purpose purpose);
  void nodal_loads(double* nodal) const;

  coupling::System& system_;
  const structure::ModalBridge& bridge_;
  structure::BeamOperator& statics_;
  train::MovingLoad load_;
  ForceHistory history_;
  ModalMotion motion_;
  base::Handle<TS> ts_;  // TS of the type modal; it advances motion_
  PetscInt most_steps_ = 0;
  double longest_step_ = 0.0;  // s
  double end_time_, interval_;
  long stored_;                  // one sample out of this number is stored
  std::vector<double> sagging_;  // displacements of this rank's unknowns under the self-weight, m
  std::vector<double> y_, acceleration_, drag_, force_;  // same meaning as in Instant; nodal forces
  Eigen::MatrixXd shapes_;                               // of the modes, this rank's unknowns
  Eigen::VectorXd share_;                                // modal forces, and an energy
  Eigen::ArrayXd amplitude_;                             // of each mode
  double at_start_ = 0.0;                                // J, initial energy of the static correction
  bool has_drag_ = false, begun_ = false;
  long steps_ = 0;
};

}  // namespace traverse::integrate
