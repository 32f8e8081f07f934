// The inverse of a vehicle's Newton matrix, in a form that depends on its size.
#pragma once

#include <Eigen/Dense>

#include "solve/band_lu.hpp"

namespace traverse::train {

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

}  // namespace traverse::train
