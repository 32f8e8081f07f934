// The inverse of a vehicle's Newton matrix, in the form that suits its size.
#pragma once

#include <Eigen/Dense>

#include "solve/band_lu.hpp"

namespace traverse::train {

class NewtonInverse {
 public:
  /// singular: some coordinates may be neutral.
  void compute(const Eigen::MatrixXd& J, bool singular);
  void apply(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;
  void keep(base::Bytes& bytes) { bytes(form_, whole_, band_, lu_, order_); }

 private:
  enum class Form { whole, band, factors } form_ = Form::whole;
  Eigen::MatrixXd whole_;
  solve::BandLu band_;
  Eigen::MatrixXd lu_;                            // L D^-1 and D U one above the other, of the rows in this order
  Eigen::VectorXi order_;                         // where each row goes
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;  // at work
};

}  // namespace traverse::train
