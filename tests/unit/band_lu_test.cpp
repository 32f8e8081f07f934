// The banded LU of long trains against the full one.
#include "solve/band_lu.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace traverse::solve {
namespace {

Eigen::MatrixXd banded(int size, int band) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Random(size, size);  // small on the diagonal: rows have to change places
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i)
      if (std::abs(i - j) > band) A(i, j) = 0.0;
  return A;
}

TEST(BandLu, SolvesAsTheFullOneDoes) {
  for (const auto& [size, band] :
       {std::pair(1, 0), std::pair(5, 4), std::pair(40, 1), std::pair(60, 7), std::pair(90, 0)}) {
    const Eigen::MatrixXd A = banded(size, band);
    ASSERT_EQ(half_bandwidth(A), band);
    const Eigen::MatrixXd X = Eigen::MatrixXd::Random(size, 3);
    Eigen::MatrixXd solved = A * X;
    BandLu lu;
    lu.compute(A, band);
    lu.solve_in_place(solved);
    EXPECT_LT((solved - X).norm(), 1e-9 * X.norm()) << size << " with " << band;
  }
}

TEST(BandLu, FindsTheBandOfWhatIsNotZero) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(30, 30);
  EXPECT_EQ(half_bandwidth(A), 0);
  A(3, 9) = 1e-300;
  EXPECT_EQ(half_bandwidth(A), 6);
  A(25, 14) = -1.0;
  EXPECT_EQ(half_bandwidth(A), 11);
}

}  // namespace
}  // namespace traverse::solve
