// A vehicle as the mechanism that it is: generalized coordinate partitioning (the paper's section 5), all angles as
// large as they come. J hardly changes: what follows from it is kept over stages and steps.
#pragma once

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
  bool worn(const MovingVehicle& vehicle) const override { return vehicle.mechanism.worn(vehicle.state); }
  bool accept(MovingVehicle& vehicle) override;

  bool find_residual(MovingVehicle& vehicle, const double* pdd, ContactCompliance& compliance) override;
  bool serves(const MovingVehicle& vehicle, const StageShifts& shifts, bool curved) const override;
  void renew(MovingVehicle& vehicle, const StageShifts& shifts, bool curved, ContactRows rows,
             ContactCompliance& compliance) override;
  void go_by_itself(ContactCompliance& compliance) override { newton_.go_by_itself(R_, compliance); }
  void rest() override { R_.setZero(); }
  const Eigen::VectorXd& take(const Eigen::VectorXd& forces) override { return newton_.take(forces); }
  void keep(base::Bytes& bytes) override { bytes(newton_, shifts_, partition_version_, curved_, R_, pdd_); }

 private:
  void find_J(MovingVehicle& vehicle, const StageShifts& shifts, bool curved);

  // kept
  VehicleNewton newton_;
  StageShifts shifts_;  // that it was computed for; 0: none
  int partition_version_ = 0;
  bool curved_ = false;

  Eigen::VectorXd R_, r_;
  Eigen::VectorXd pdd_;  // as the residual was last asked for
  Eigen::MatrixXd J_, NB_;
  Eigen::MatrixXd projector_;           // in place of B where joints rub
  VehicleNewton::RowMatrix projected_;  // directions times projector
  ColumnRanges everything_;
};

}  // namespace traverse::train
