// A vehicle as a mechanism with large rotations: generalized coordinate partitioning (the paper's section 5). J changes
// little: the matrices derived from it are reused in later stages and steps.
#pragma once

#include "augmented_newton.hpp"
#include "train/fleet.hpp"
#include "vehicle_newton.hpp"

namespace traverse::train {

class MultibodyDynamics : public VehicleDynamics {
 public:
  std::unique_ptr<VehicleDynamics> clone() const override { return std::make_unique<MultibodyDynamics>(*this); }

  bool set(MovingVehicle& vehicle, double t, const double* p, const double* pd) override;
  void shift(MovingVehicle& vehicle, const double* change, double rate) override;
  void accelerations(MovingVehicle& vehicle, double* pdd) override;
  void recover(MovingVehicle& vehicle, const double* pdd) override;
  multibody::MechanismPowers powers(const MovingVehicle& vehicle) const override {
    return vehicle.mechanism.powers(vehicle.state);
  }
  multibody::MechanismEnergy energy(const MovingVehicle& vehicle) const override {
    return vehicle.mechanism.energy(vehicle.state);
  }
  bool observe(MovingVehicle&, const double*) override { return false; }
  bool badly_conditioned(MovingVehicle& vehicle) const override {
    return vehicle.mechanism.badly_conditioned(vehicle.state);
  }
  bool accept(MovingVehicle& vehicle) override;

  bool find_residual(MovingVehicle& vehicle, const double* pdd, ContactCompliance& compliance) override;
  bool matrix_is_valid(const MovingVehicle& vehicle, const StageShifts& shifts, bool curved) const override;
  void renew(MovingVehicle& vehicle, const StageShifts& shifts, bool curved, ContactRows rows,
             ContactCompliance& compliance) override;
  void compute_free_displacement(ContactCompliance& compliance) override {
    is_augmented_ ? augmented_.compute_free_displacement(R_, compliance)
                  : newton_.compute_free_displacement(R_, compliance);
  }
  void clear_residual() override { R_.setZero(); }
  const Eigen::VectorXd& coordinate_change(const Eigen::VectorXd& forces) override {
    return is_augmented_ ? augmented_.coordinate_change(forces) : newton_.coordinate_change(forces);
  }
  void keep(base::Bytes& bytes) override {
    bytes(newton_, augmented_, shifts_, partition_version_, curved_, is_augmented_, R_, pdd_);
  }

 private:
  void compute_J(MovingVehicle& vehicle, const StageShifts& shifts, bool curved);

  // reused in later stages and steps
  VehicleNewton newton_;
  AugmentedNewton augmented_;  // in its place where B has many entries
  StageShifts shifts_;         // shifts of the stage for which J was computed; 0: none
  int partition_version_ = 0;
  bool curved_ = false, is_augmented_ = false;

  Eigen::VectorXd R_, r_;
  Eigen::VectorXd pdd_;  // p'' of the last residual
  Eigen::MatrixXd J_, NB_;
  Eigen::MatrixXd projector_;           // in place of B for joints with friction
  VehicleNewton::RowMatrix projected_;  // directions times projector
  ColumnRanges all_columns_;
};

}  // namespace traverse::train
