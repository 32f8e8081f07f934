// A vehicle as the mechanism that it is: generalized coordinate partitioning (the paper's section 5), all angles as
// large as they come. J hardly changes: what follows from it is kept over stages and steps.
#pragma once

#include <vector>

#include "newton_inverse.hpp"
#include "traverse/train/fleet.hpp"

namespace traverse::train {

class MultibodyDynamics : public VehicleDynamics {
 public:
  std::unique_ptr<VehicleDynamics> clone() const override { return std::make_unique<MultibodyDynamics>(*this); }

  bool set(MovingVehicle& vehicle, double t, const double* p, const double* pd) override;
  void shift(MovingVehicle& vehicle, const double* change, double rate) override;
  void accelerations(MovingVehicle& vehicle, double* pdd) override;
  void recover(MovingVehicle& vehicle, const double* pdd) override;

  bool find_residual(MovingVehicle& vehicle, const double* pdd, VehicleYield& yield) override;
  bool serves(const MovingVehicle& vehicle, const StageShifts& shifts, bool curved) const override;
  void renew(MovingVehicle& vehicle, const StageShifts& shifts, bool curved, ContactRows rows,
             VehicleYield& yield) override;
  void go_by_itself(VehicleYield& yield) override;
  void rest() override { R_.setZero(); }
  const Eigen::VectorXd& take(const Eigen::VectorXd& forces) override;

 private:
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  void find_J(MovingVehicle& vehicle, const StageShifts& shifts, bool curved);
  void add_contacts(const RowMatrix& left, const RowTangent& D);

  // kept
  NewtonInverse inverse_;                      // of J
  RowMatrix G_;                                // contact directions times B, r x f
  Eigen::MatrixXd Y_;                          // J^-1 G^T, f x r
  std::vector<multibody::ColumnRange> range_;  // of every row of G
  StageShifts shifts_;                         // that they were computed for; 0: none
  int partition_version_ = 0;
  bool curved_ = false;

  Eigen::VectorXd R_, dx_, r_, s_;
  Eigen::MatrixXd J_, NB_;
  Eigen::MatrixXd projector_;  // in place of B where joints rub
  RowMatrix projected_;        // directions times projector
  RowMatrix DG_;               // the law's tangent times G
  std::vector<multibody::ColumnRange> everything_;
  Eigen::VectorXd pdd_;  // as the residual was last asked for
};

}  // namespace traverse::train
