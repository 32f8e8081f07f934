// LU with partial pivoting of a banded matrix: the Newton matrix of a long train of coupled vehicles, in which each
// vehicle is coupled to its neighbours only. Storage and elimination are as in LAPACK's band routines.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/bytes.hpp"

namespace traverse::solve {

/// The largest distance of a non-zero entry from the diagonal.
int half_bandwidth(const Eigen::MatrixXd& A);

class BandLu {
 public:
  void compute(const Eigen::MatrixXd& A, int half_bandwidth);
  /// compute() in three calls: set zeros, set the entries (i, j) with |i - j| <= half_bandwidth, factorise.
  void set_zero(int size, int half_bandwidth);
  double& entry(int i, int j) { return lu_(2 * band_ + i - j, j); }
  void factor();
  void solve_in_place(Eigen::MatrixXd& X) const;
  void solve_in_place(double* x) const;
  void keep(base::Bytes& bytes) { bytes(size_, band_, above_, lu_, inverse_pivot_, pivot_row_); }

 private:
  int size_ = 0, band_ = 0;
  int above_ = 0;       // largest number of entries of the upper factor above the diagonal; larger after row exchanges
  Eigen::MatrixXd lu_;  // entry (i, j) at (2 band + i - j, j)
  std::vector<double> inverse_pivot_;
  std::vector<int> pivot_row_;
};

}  // namespace traverse::solve
