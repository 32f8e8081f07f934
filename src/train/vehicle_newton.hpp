// The condensation of a vehicle's Newton matrix J onto its contact rows, for all kinds of dynamics.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "multibody/mechanism.hpp"
#include "solve/band_lu.hpp"
#include "train/vehicle_dynamics.hpp"

namespace traverse::train {

/// The inverse of a vehicle's Newton matrix, in a form that depends on its size.
class NewtonInverse {
 public:
  /// singular: some coordinates may have no stiffness.
  void compute(const Eigen::MatrixXd& J, bool singular);
  void apply(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;
  void keep(base::Bytes& bytes) { bytes(form_, inverse_, band_, lu_, order_); }

 private:
  enum class Form { whole, band, factors } form_ = Form::whole;
  Eigen::MatrixXd inverse_;
  solve::BandLu band_;
  Eigen::MatrixXd lu_;                            // L D^-1 and D U of the permuted rows in one matrix
  Eigen::VectorXi order_;                         // new position of each row
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;  // work space
};

/// For each body the columns that its three rows of coordinates extend over.
using ColumnRanges = std::vector<multibody::ColumnRange>;

class VehicleNewton {
 public:
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// G = (contact directions) B, of r rows and f columns, and compliance.H = G J^-1 left^T, where `left` differs from G
  /// only for joints with friction. In statics the contacts' tangent compliance.D is added to J, some of whose
  /// coordinates may have no stiffness.
  void renew(ContactRows rows, const ColumnRanges& columns, const Eigen::MatrixXd& B, const RowMatrix* left,
             bool statics, Eigen::MatrixXd& J, ContactCompliance& compliance);
  /// compliance.c = -G J^-1 R.
  void compute_free_displacement(const Eigen::VectorXd& R, ContactCompliance& compliance);
  /// -J^-1 (R + left^T forces), with the R of the last call of compute_free_displacement.
  const Eigen::VectorXd& coordinate_change(const Eigen::VectorXd& forces);

  /// Stores (contact directions) B in G.
  static void multiply_directions(ContactRows rows, const ColumnRanges& columns, const Eigen::MatrixXd& B,
                                  RowMatrix& G);

  void keep(base::Bytes& bytes) { bytes(inverse_, G_, Y_, range_, DG_, dx_, s_); }

 private:
  void add_contacts(const RowMatrix& left, const RowTangent& D, Eigen::MatrixXd& J);

  NewtonInverse inverse_;  // inverse of J
  RowMatrix G_;
  Eigen::MatrixXd Y_;   // J^-1 left^T, f x r
  ColumnRanges range_;  // column ranges of every row of G
  RowMatrix DG_;        // the law's tangent times G
  Eigen::VectorXd dx_, s_;
};

}  // namespace traverse::train
