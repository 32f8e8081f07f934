// A vehicle with constant matrices about its initial state, and the error of this model. The error is of second order
// in the angles: the residual of the mechanism's equations is proportional to the squares of the coordinates from the
// state of linearisation.
//
// With the independent coordinates p = p0 + c s(t) + x, where c is the steady motion along the track, all bodies are at
// q = q0 + u s(t) + B x, and the mechanism's projected equations of motion become
//
//   M x'' + C x' + K x + r0 + B^T N u s'' = B^T Q,   M = B^T N B,   r0 = -B^T g0
//
// At a constant speed s is the time, and u = B c + b. At a changing speed s is the distance that the drives prescribe
// (MovingVehicle::travel), and u is a translation by one metre in which free wheels with friction roll: a train may
// start from rest. s'' is piecewise constant, and each step uses the side of a jump that the drives use.
//
// K includes the springs' stiffness and the rotation with x of the joints' initial reactions, without acceleration:
// the product of s'' and x is of second order.
#pragma once

#include <string>
#include <vector>

#include "train/fleet.hpp"
#include "vehicle_newton.hpp"

namespace traverse::train {

/// The matrices about p0, moving with c: M, C, K (f x f), r0 (f) and B (n x f) of the equations above. driven = B^T N u
/// (f), driven_mass = u^T N u: s' (driven^T x'' + driven_mass s'') is the power that drives the masses. q0, u (n):
/// initial coordinates and steady rates of all bodies.
struct LinearMatrices {
  const Eigen::MatrixXd &M, &C, &K, &B;
  const Eigen::VectorXd &r0, &p0, &c, &driven, &q0, &u;
  double driven_mass;
};

class LinearDynamics : public VehicleDynamics {
 public:
  /// The reason why a vehicle cannot be linearised; empty: it can.
  static std::string obstacle(const MovingVehicle& vehicle);

  /// Linearises about the vehicle's evaluated state at t = 0, with its contact forces in Q. cruise: c of its
  /// coordinates for the vehicle's `travel`.
  LinearDynamics(MovingVehicle& vehicle, const double* cruise);

  LinearMatrices matrices() const { return {M_, C_, K_, B_, r0_, p0_, c_, driven_, q0_, u_, driven_mass_}; }
  const LinearDynamics* linear() const override { return this; }
  std::unique_ptr<VehicleDynamics> clone() const override { return std::make_unique<LinearDynamics>(*this); }

  bool set(MovingVehicle& vehicle, double t, const double* p, const double* pd) override;
  void shift(MovingVehicle& vehicle, const double* change, double rate) override;
  void accelerations(MovingVehicle& vehicle, double* pdd) override;
  void recover(MovingVehicle&, const double* pdd) override;
  base::Powers powers(const MovingVehicle& vehicle) const override;
  multibody::MechanismEnergy energy(const MovingVehicle& vehicle) const override;
  bool observe(MovingVehicle& vehicle, const double* pdd) override;
  /// The largest residual of the mechanism's own equations of motion in the observed states, over the vehicle's scale.
  double linearisation_residual() const { return linearisation_residual_; }

  bool find_residual(MovingVehicle& vehicle, const double* pdd, ContactCompliance& compliance) override;
  bool matrix_is_valid(const MovingVehicle& vehicle, const StageShifts& shifts, bool curved) const override;
  void renew(MovingVehicle& vehicle, const StageShifts& shifts, bool curved, ContactRows rows,
             ContactCompliance& compliance) override;
  void compute_free_displacement(ContactCompliance& compliance) override {
    newton_.compute_free_displacement(R_, compliance);
  }
  const Eigen::VectorXd& coordinate_change(const Eigen::VectorXd& forces) override {
    return newton_.coordinate_change(forces);
  }
  void keep(base::Bytes& bytes) override {
    bytes(newton_, shifts_, time_, s_, rate_, acceleration_, linearisation_residual_, x_, xd_, xdd_, force_, R_);
  }

 private:
  void set_travel(const MovingVehicle& vehicle, double t);
  void find_force(const MovingVehicle& vehicle);

  Eigen::VectorXd p0_, c_;  // f
  Eigen::VectorXd q0_, u_;  // n
  Eigen::MatrixXd B_;       // n x f
  Eigen::MatrixXd M_, C_, K_;
  Eigen::LLT<Eigen::MatrixXd> mass_;
  Eigen::VectorXd r0_;      // f
  Eigen::VectorXd driven_;  // f: N u projected
  double driven_mass_ = 0.0;
  bool drives_ = false;  // the train's speed is prescribed
  ColumnRanges columns_;
  VehicleNewton newton_;
  StageShifts shifts_;
  double initial_energy_ = 0.0;                                    // strain and potential energy at x = 0, J
  double time_ = 0.0, s_ = 0.0, rate_ = 0.0, acceleration_ = 0.0;  // s; s, s' and s'' at that time
  double linearisation_residual_ = 0.0;
  Eigen::VectorXd x_, xd_, xdd_;  // f
  Eigen::VectorXd force_;         // f: B^T Q - C x' - K x - r0 - B^T N u s''
  Eigen::VectorXd r_, position_, velocity_, pdd_;
  Eigen::MatrixXd J_;
};

/// The largest residual over the vehicle's weight with its coordinates at x from the start (m, rad). The vehicle is
/// moved to this state.
double linearisation_residual_at(MovingVehicle& vehicle, const double* x);

/// The square root of that residual per unit of each coordinate alone, 1/m or 1/rad.
std::vector<double> residual_roots(MovingVehicle vehicle);

}  // namespace traverse::train
