// The sparse L D L^T against a dense solver, and its count of operations.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "multibody/sparse_ldl.hpp"

namespace traverse::multibody {
namespace {

/// Factors A and solves with it.
Eigen::VectorXd solve(SparseLdl& ldl, const Eigen::MatrixXd& A, Eigen::VectorXd x) {
  const auto n = static_cast<int>(A.rows());
  std::vector<char> filled(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) filled[static_cast<std::size_t>(i * n + j)] = A(i, j) != 0.0 ? 1 : 0;
  ldl.plan(n, filled);
  ldl.set_zero();
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j)
      if (A(i, j) != 0.0) ldl.entries()[ldl.entry_index(j, i)] += A(i, j);
  ldl.factor();
  ldl.solve(x.data());
  return x;
}

TEST(SparseLdl, SolvesAndCountsAnArrow) {
  // the hub comes first in A and last in the elimination: nothing fills
  Eigen::MatrixXd A = 4.0 * Eigen::MatrixXd::Identity(6, 6);
  A.row(0).tail(5).setLinSpaced(0.5, 1.0);
  A.col(0) = A.row(0).transpose();
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(6, -1.0, 2.0);
  SparseLdl ldl;
  EXPECT_LT((solve(ldl, A, b) - A.llt().solve(b)).norm(), 1e-14);
  // a column of one entry: inverse, scaling, one product subtracted
  EXPECT_EQ(ldl.factor_operations(), 5 * (1 + 1 + 2) + 1);
  EXPECT_EQ(ldl.solve_operations(), 5 * 4 + 6);
}

TEST(SparseLdl, SolvesAndCountsAFullMatrix) {
  Eigen::MatrixXd A(3, 3);
  A << 4.0, 1.0, 0.5, 1.0, 3.0, -0.7, 0.5, -0.7, 2.0;
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3, 1.0, -2.0);
  SparseLdl ldl;
  EXPECT_LT((solve(ldl, A, b) - A.llt().solve(b)).norm(), 1e-14);
  EXPECT_EQ(ldl.factor_operations(), (1 + 2 + 6) + (1 + 1 + 2) + 1);
  EXPECT_EQ(ldl.solve_operations(), 3 * 4 + 3);
}

}  // namespace
}  // namespace traverse::multibody
