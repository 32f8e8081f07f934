// The condensation of a vehicle onto its contact rows as in vehicle_newton.hpp, with the augmented equations in place
// of J = B^T K B. Its cost grows linearly with the number of bodies in a chain.
#pragma once

#include <vector>

#include "multibody/augmented_system.hpp"
#include "train/vehicle_dynamics.hpp"

namespace traverse::train {

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

}  // namespace traverse::train
