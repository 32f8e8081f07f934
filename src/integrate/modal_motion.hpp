// The modes' motion under moving forces, exact in time: between two passages of breaks the modal force is a cubic
// polynomial of time, so
//   q(t) = polynomial + free oscillation,   q'' + 2 sigma q' + omega^2 q = g(t).
// Of modes that damping couples the polynomials solve the coupled equations, and the free oscillation is that of the
// complex modes. Rounding alone is in the result, however far apart the instants are.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "integrate/coupled_oscillation.hpp"
#include "integrate/force_history.hpp"
#include "integrate/free_oscillation.hpp"
#include "structure/modal_bridge.hpp"

namespace traverse::integrate {

class ModalMotion {
 public:
  /// Starts at t = 0: in static equilibrium under the forces that stand on the bridge then, or undeflected. All three
  /// must outlive it.
  ModalMotion(const structure::ModalBridge& bridge, const ForceHistory& history, double speed, bool equilibrium);

  /// Steps of this length cost less than others.
  void expect(double dt);
  /// From now on counts the work of the forces and what dampers take, which more than doubles the cost.
  void count_energy() { counting_ = true; }
  /// Moves on to a time t not before the last one; q, ... are then those of t, and where something jumps at t those
  /// just before it.
  void advance(double t);
  /// The next time at which a force passes a break; infinite after the last one.
  double next_event() const;
  /// At the time of an event: q, ... become those just after it.
  void pass_event();
  double time() const { return time_; }

  const std::vector<double>& q() const { return q_; }
  const std::vector<double>& rate() const { return rate_; }
  const std::vector<double>& acceleration() const { return acceleration_; }
  /// Adds `count` of the history's channels at this time, from `first` on.
  void add_channels(std::size_t first, std::size_t count, double* sum) const;
  double dissipated() const { return dissipated_; }  // J, since t = 0
  double work() const { return work_; }              // J, of the forces on the modes' motion
  void keep(base::Bytes& bytes) {
    bytes(interval_, time_, modes_, q_, rate_, acceleration_, u_, w_, dissipated_, work_);
    if (coupled_) coupled_->keep(bytes);
  }

 private:
  struct Mode {
    std::array<double, 4> particular{};  // by powers of the time since the interval's start
    double u = 0.0, w = 0.0;             // the free oscillation and its rate, now
  };
  void enter(std::size_t interval);
  void enter_coupled();
  void move(double dt);
  void move_counting(double dt);
  void move_coupled_counting(double dt);
  void record_free();
  void add_channels_at(double s, std::size_t first, std::size_t count, double* sum) const;
  void see();

  const structure::ModalBridge& bridge_;
  const ForceHistory& history_;
  double speed_;
  std::size_t interval_ = 0;
  double time_ = 0.0;
  std::vector<Mode> modes_;
  std::vector<double> q_, rate_, acceleration_;
  std::vector<FreeOscillation> expected_;
  double expected_dt_ = -1.0;
  double highest_ = 0.0;  // rad/s
  bool counting_ = false;
  std::optional<CoupledOscillation> coupled_;  // keeps the free oscillation of coupled modes
  Eigen::VectorXcd expected_coupled_;
  Eigen::VectorXd u_, w_;  // that oscillation and its rate, now
  double dissipated_ = 0.0, work_ = 0.0;
};

}  // namespace traverse::integrate
