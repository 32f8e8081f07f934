// LU with partial pivoting of a banded matrix: the Newton matrix of a long train whose vehicles are joined, where each
// meets its neighbours only. Storage and elimination as in LAPACK's band routines.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace traverse::coupling {

/// The greatest distance of a non-zero entry from the diagonal.
int half_bandwidth(const Eigen::MatrixXd& A);

class BandLu {
 public:
  void compute(const Eigen::MatrixXd& A, int half_bandwidth);
  void solve_in_place(Eigen::MatrixXd& X) const;

 private:
  int size_ = 0, band_ = 0;
  Eigen::MatrixXd lu_;  // entry (i, j) at (2 band + i - j, j)
  std::vector<int> pivot_row_;
};

}  // namespace traverse::coupling
