// The modal motion under moving forces, exact in time: between two breaks of the influence lines the modal force is a
// cubic polynomial of time, so
//   q(t) = polynomial + free oscillation,   q'' + 2 sigma q' + omega^2 q = g(t).
// If damping couples modes, the polynomials satisfy the coupled equations, and the free oscillation is computed by the
// complex modes. The only error is rounding, for any interval between instants.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "integrate/force_history.hpp"
#include "integrate/oscillation.hpp"
#include "structure/modal_bridge.hpp"

namespace traverse::integrate {

class ModalMotion {
 public:
  /// Starts at t = 0, in static equilibrium under the forces on the bridge, or undeflected. The bridge and the history
  /// must outlive this object.
  ModalMotion(const structure::ModalBridge& bridge, const ForceHistory& history, double speed, bool equilibrium);

  /// Prepares steps of this length, which then cost less than others. Call after integrate_energy().
  void prepare(double dt);
  /// From now on integrates the work of the forces and the dissipation of dampers, which more than doubles the cost.
  void integrate_energy() { integrates_energy_ = true; }
  /// Moves to a time t not before the last one; q, rate and acceleration are then the values at t, before a jump at t.
  void advance(double t);
  /// Like advance(), but only the acceleration is that at t, which costs less.
  void advance_acceleration(double t);
  /// The next time at which a force passes a break; infinite after the last one.
  double next_event() const;
  /// At the time of an event: changes q, rate and acceleration to the values after it.
  void pass_event();
  double time() const { return time_; }

  const std::vector<double>& q() const { return q_; }
  const std::vector<double>& rate() const { return rate_; }
  const std::vector<double>& acceleration() const { return acceleration_; }
  /// Adds `count` of the history's channels at the present time, from `first` on.
  void add_channels(std::size_t first, std::size_t count, double* sum) const;
  double dissipated() const { return dissipated_; }  // J, since t = 0
  double work() const { return work_; }              // J, work of the forces in the modal motion
  void keep(base::Bytes& bytes) {
    bytes(interval_, time_, modes_, q_, rate_, acceleration_, u_, w_, dissipated_, work_);
    if (coupled_) coupled_->keep(bytes);
  }

 private:
  struct Mode {
    std::array<double, 4> particular{};  // coefficients of the powers of the time since the interval's start
    double u = 0.0, w = 0.0;             // the free oscillation and its rate at the present time
    double omega2 = 0.0, damping = 0.0;  // omega^2, 1/s2; 2 sigma, 1/s
  };
  void enter(std::size_t interval);
  void enter_coupled();
  void move(double dt);
  double energy_part(double dt) const;
  void move_with_energy(double dt, bool prepared);
  void move_coupled_with_energy(double dt, bool prepared);
  void record_free();
  void add_channels_at(double s, std::size_t first, std::size_t count, double* sum) const;
  void move_to(double t);
  void update_state();
  void update_acceleration();
  /// The factors of a mode, or of all complex modes, at the Gauss points of a part of a step and at its end.
  template <class Factors>
  using Inside = std::array<Factors, 6>;
  Inside<FreeOscillation> inside(std::size_t mode, double part) const;
  Inside<Eigen::VectorXcd> coupled_inside(double part) const;
  double since_event() const { return speed_ > 0.0 ? time_ - history_.start[interval_] / speed_ : 0.0; }

  const structure::ModalBridge& bridge_;
  const ForceHistory& history_;
  double speed_;
  std::size_t interval_ = 0;
  double time_ = 0.0;
  std::vector<Mode> modes_;
  std::vector<double> q_, rate_, acceleration_;
  std::vector<FreeOscillation> prepared_;
  std::vector<Inside<FreeOscillation>> prepared_inside_;  // with energies
  double prepared_dt_ = -1.0;
  double highest_ = 0.0;  // rad/s
  bool integrates_energy_ = false;
  std::optional<CoupledOscillation> coupled_;  // the free oscillation of coupled modes
  Eigen::VectorXcd prepared_coupled_;
  Inside<Eigen::VectorXcd> prepared_coupled_inside_;
  Eigen::VectorXd u_, w_;  // this oscillation and its rate at the present time
  double dissipated_ = 0.0, work_ = 0.0;
};

}  // namespace traverse::integrate
