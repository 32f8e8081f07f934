// A vehicle as a mechanism with large rotations: generalized coordinate partitioning (the paper's section 5). J changes
// little: the matrices derived from it are reused in later stages and steps.
#pragma once

#include <vector>

#include "multibody/augmented_system.hpp"
#include "train/fleet.hpp"
#include "train/vehicle_dynamics.hpp"
#include "vehicle_newton.hpp"

namespace traverse::train {

/// The condensation of a vehicle onto its contact rows as in vehicle_newton.hpp, with the augmented equations in place
/// of J = B^T K B. Its cost grows linearly with the number of bodies in a chain.
class AugmentedNewton {
 public:
  /// Computes and factorises the matrix of the stage, with the curvature of the constraints at p'' unless that is null,
  /// and compliance.H. False if its pivots have the wrong signs, so that the projected matrix is needed. In statics the
  /// contacts' tangent compliance.D, of contacts with the ground only, is included.
  bool renew(MovingVehicle& vehicle, const StageShifts& shifts, const double* pdd, ContactRows rows,
             ContactCompliance& compliance);
  /// compliance.c = -G J^-1 R, with the projected residual R.
  void compute_free_displacement(const Eigen::VectorXd& R, ContactCompliance& compliance);
  /// -J^-1 (R + G^T forces), with the R of the last call of compute_free_displacement.
  const Eigen::VectorXd& coordinate_change(const Eigen::VectorXd& forces);
  void keep(base::Bytes& bytes) { bytes(system_, partition_version_, independent_, directions_, dq_, dx_); }

 private:
  /// The direction of a contact row in the coordinates of one or two bodies.
  struct Direction {
    int body = 0, other = multibody::ground;
    std::array<double, 3> on_body{}, on_other{};
    double dot(const Eigen::Ref<const Eigen::VectorXd>& q) const;
    /// r += force times the direction.
    void add_to(double force, Eigen::VectorXd& r) const;
  };
  static Direction direction_of(const ContactRow& row);
  void add_contacts(const RowTangent& D);

  multibody::AugmentedSystem system_;
  int partition_version_ = 0;
  std::vector<int> independent_;
  std::vector<Direction> directions_;
  Eigen::VectorXd dq_, by_forces_;  // n
  Eigen::VectorXd dx_;              // f
};

class MultibodyDynamics : public VehicleDynamics {
 public:
  std::unique_ptr<VehicleDynamics> clone() const override { return std::make_unique<MultibodyDynamics>(*this); }

  bool set(MovingVehicle& vehicle, double t, const double* p, const double* pd) override;
  void shift(MovingVehicle& vehicle, const double* change, double rate) override;
  void accelerations(MovingVehicle& vehicle, double* pdd) override;
  void recover(MovingVehicle& vehicle, const double* pdd) override;
  base::Powers powers(const MovingVehicle& vehicle) const override { return vehicle.mechanism.powers(vehicle.state); }
  multibody::MechanismEnergy energy(const MovingVehicle& vehicle) const override {
    return vehicle.mechanism.energy(vehicle.state);
  }
  bool observe(MovingVehicle&, const double*) override { return false; }

  bool find_residual(MovingVehicle& vehicle, const double* pdd, ContactCompliance& compliance) override;
  bool matrix_is_valid(const MovingVehicle& vehicle, const StageShifts& shifts, bool curved) const override;
  void renew(MovingVehicle& vehicle, const StageShifts& shifts, bool curved, ContactRows rows,
             ContactCompliance& compliance) override;
  void compute_free_displacement(ContactCompliance& compliance) override {
    is_augmented_ ? augmented_.compute_free_displacement(R_, compliance)
                  : newton_.compute_free_displacement(R_, compliance);
  }
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

  Eigen::VectorXd r_;
  Eigen::VectorXd pdd_;  // p'' of the last residual
  Eigen::MatrixXd J_, NB_;
  Eigen::MatrixXd projector_;           // in place of B for joints with friction
  VehicleNewton::RowMatrix projected_;  // directions times projector
  ColumnRanges all_columns_;
};

}  // namespace traverse::train
