// A vehicle's Newton matrix J condensed onto its contact rows: what every kind of dynamics does with its J.
#pragma once

#include <vector>

#include "multibody/mechanism.hpp"
#include "newton_inverse.hpp"
#include "train/vehicle_dynamics.hpp"

namespace traverse::train {

/// Columns that the rows of a body's three coordinates reach into, one range a body.
using ColumnRanges = std::vector<multibody::ColumnRange>;

class VehicleNewton {
 public:
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// G = (contact directions) B, of r rows and f columns, and yield.H = G J^-1 left^T, where `left` is G too but where
  /// joints rub. In statics J, of which some coordinates may be neutral, takes the contacts' tangent yield.D.
  void renew(ContactRows rows, const ColumnRanges& columns, const Eigen::MatrixXd& B, const RowMatrix* left,
             bool statics, Eigen::MatrixXd& J, ContactCompliance& compliance);
  /// yield.c = -G J^-1 R.
  void go_by_itself(const Eigen::VectorXd& R, ContactCompliance& compliance);
  /// -J^-1 (R + left^T forces), with the R of the last go_by_itself.
  const Eigen::VectorXd& take(const Eigen::VectorXd& forces);

  /// (contact directions) B into G.
  static void multiply_directions(ContactRows rows, const ColumnRanges& columns, const Eigen::MatrixXd& B,
                                  RowMatrix& G);

  void keep(base::Bytes& bytes) { bytes(inverse_, G_, Y_, range_, DG_, dx_, s_); }

 private:
  void add_contacts(const RowMatrix& left, const RowTangent& D, Eigen::MatrixXd& J);

  NewtonInverse inverse_;  // of J
  RowMatrix G_;
  Eigen::MatrixXd Y_;   // J^-1 left^T, f x r
  ColumnRanges range_;  // of every row of G
  RowMatrix DG_;        // the law's tangent times G
  Eigen::VectorXd dx_, s_;
};

}  // namespace traverse::train
