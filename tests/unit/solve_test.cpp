// The block tridiagonal factorisation on one rank, against Eigen's dense Cholesky and closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "base/petsc.hpp"
#include "solve/block_tridiagonal.hpp"
#include "support/random_blocks.hpp"
#include "traverse/base/error.hpp"

namespace {

using namespace traverse;
using solve::BlockTridiagonal;
using solve::SubstructuredCholesky;

double relative_difference(const Eigen::MatrixXd& x, const Eigen::MatrixXd& expected) {
  return (x - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

Eigen::MatrixXd solution(const Eigen::MatrixXd& A, int block, const std::vector<char>& fixed, Eigen::MatrixXd b) {
  const int nodes = static_cast<int>(A.rows()) / block;
  SubstructuredCholesky cholesky(MPI_COMM_SELF, block, nodes);
  cholesky.factor(test::slice(A, block, 0, nodes), fixed);
  cholesky.solve(b.data(), static_cast<int>(b.cols()));
  return b;
}

class Sizes : public testing::TestWithParam<std::tuple<int, int>> {
 protected:
  int block() const { return std::get<0>(GetParam()); }
  int nodes() const { return std::get<1>(GetParam()); }
  int unknowns() const { return block() * nodes(); }
};

TEST_P(Sizes, SolvesAsTheDenseMatrix) {
  const Eigen::MatrixXd A = test::random_spd(block(), nodes(), 0.1, 1);
  for (int columns = 1; columns <= 8; ++columns) {
    const Eigen::MatrixXd b = test::random_matrix(unknowns(), columns, 2);
    EXPECT_LT(relative_difference(solution(A, block(), {}, b), test::dense_solution(A, {}, b)), 1e-12) << columns;
  }
}

TEST_P(Sizes, FixedUnknownsKeepTheirRightHandSide) {
  const Eigen::MatrixXd A = test::random_spd(block(), nodes(), 0.1, 3);
  const std::vector<char> fixed = test::random_fixed(unknowns(), 4);
  const Eigen::MatrixXd b = test::random_matrix(unknowns(), 3, 5);
  const Eigen::MatrixXd x = solution(A, block(), fixed, b);
  EXPECT_LT(relative_difference(x, test::dense_solution(A, fixed, b)), 1e-12);
  for (int i = 0; i < unknowns(); ++i) {
    if (fixed[static_cast<std::size_t>(i)] != 0) {
      EXPECT_EQ(x(i, 1), b(i, 1));
    }
  }
}

TEST_P(Sizes, IsolatedSpansDoNotTalk) {
  Eigen::MatrixXd A = test::random_spd(block(), nodes(), 0.1, 6);
  for (int node = 1; node + 1 < nodes(); node += 3) test::disconnect(A, block(), node);
  const Eigen::MatrixXd b = test::random_matrix(unknowns(), 2, 7);
  EXPECT_LT(relative_difference(solution(A, block(), {}, b), test::dense_solution(A, {}, b)), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Solve, Sizes, testing::Combine(testing::Range(1, 7), testing::Values(1, 2, 3, 4, 5, 50)));
INSTANTIATE_TEST_SUITE_P(SolveWide, Sizes, testing::Combine(testing::Values(7, 12, 16), testing::Values(1, 2, 3, 10)));

// -u'' = 1 by second differences, u = 0 at both ends: u_i = i(n + 1 - i)/2 exactly.
TEST(Solve, SecondDifferencesGiveTheParabola) {
  const int n = 1000;
  BlockTridiagonal A(1, n);
  for (double& entry : A.diagonal) entry = 2.0;
  for (double& entry : A.upper) entry = -1.0;
  SubstructuredCholesky cholesky(MPI_COMM_SELF, 1, n);
  cholesky.factor(A, {});
  std::vector<double> x(n, 1.0);
  cholesky.solve(x.data());
  for (int i = 1; i <= n; ++i) EXPECT_NEAR(x[static_cast<std::size_t>(i - 1)] / (0.5 * i * (n + 1 - i)), 1.0, 1e-11);
}

TEST(Solve, FactorsAgainWithOtherValues) {
  const int block = 2;
  const int nodes = 20;
  SubstructuredCholesky cholesky(MPI_COMM_SELF, block, nodes);
  for (unsigned seed = 10; seed < 13; ++seed) {
    const Eigen::MatrixXd A = test::random_spd(block, nodes, 0.1, seed);
    Eigen::MatrixXd x = test::random_matrix(A.rows(), 1, seed + 10);
    const Eigen::MatrixXd expected = test::dense_solution(A, {}, x);
    cholesky.factor(test::slice(A, block, 0, nodes), {});
    cholesky.solve(x.data());
    EXPECT_LT(relative_difference(x, expected), 1e-12);
  }
}

// A response that dies out: e^-1 a node over 2,000 nodes ends far below the smallest number, and ends in zero.
TEST(Solve, ResponsesThatDieOutEndInZero) {
  const int n = 2000;
  BlockTridiagonal A(1, n);
  for (double& entry : A.diagonal) entry = 2.0 * std::cosh(1.0);
  for (double& entry : A.upper) entry = -1.0;
  SubstructuredCholesky cholesky(MPI_COMM_SELF, 1, n);
  cholesky.factor(A, {});
  std::vector<double> x(n, 0.0);
  x[0] = 1.0;
  cholesky.solve(x.data());
  for (std::size_t i = 0; i < 600; ++i) {
    const double exact = std::exp(-1.0 - static_cast<double>(i));  // of the half-infinite chain
    EXPECT_NEAR(x[i] / exact, 1.0, 1e-12);
  }
  EXPECT_EQ(x[1500], 0.0);
}

TEST(Solve, NotPositiveDefiniteNamesTheUnknown) {
  for (int block : {1, 2, 3, 4}) {
    Eigen::MatrixXd A = 4.0 * Eigen::MatrixXd::Identity(10 * block, 10 * block);
    const int unknown = 7 * block + block - 1;
    A(unknown, unknown) = -1.0;
    try {
      (void)solution(A, block, {}, Eigen::MatrixXd::Ones(A.rows(), 1));
      FAIL() << "no error for block " << block;
    } catch (const SolverError& error) {
      EXPECT_NE(std::string(error.what()).find("unknown " + std::to_string(unknown) + " "), std::string::npos)
          << error.what();
    }
  }
}

TEST(Solve, AFloatingChainIsAnErrorUntilItIsHeld) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(5, 5);
  for (int i = 0; i < 4; ++i) A.block(i, i, 2, 2) += (Eigen::Matrix2d() << 1.0, -1.0, -1.0, 1.0).finished();
  const Eigen::MatrixXd b = Eigen::MatrixXd::Ones(5, 1);
  EXPECT_THROW((void)solution(A, 1, {}, b), SolverError);
  const std::vector<char> held = {1, 0, 0, 0, 0};
  EXPECT_LT(relative_difference(solution(A, 1, held, b), test::dense_solution(A, held, b)), 1e-14);
}

TEST(Solve, NumbersThatAreNoneAreAnError) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(6, 6);
  A(2, 2) = std::nan("");
  EXPECT_THROW((void)solution(A, 2, {}, Eigen::MatrixXd::Ones(6, 1)), SolverError);
}

TEST(Solve, PivotRatioTellsTheCancellation) {
  SubstructuredCholesky cholesky(MPI_COMM_SELF, 2, 3);
  cholesky.factor(test::slice(3.0 * Eigen::MatrixXd::Identity(6, 6), 2, 0, 3), {});
  EXPECT_EQ(cholesky.pivot_ratio(), 1.0);
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(6, 6);
  A(2, 3) = A(3, 2) = 1.0 - 0x1p-21;  // the second pivot is 1 - (1 - e)^2 = 2e - e^2
  cholesky.factor(test::slice(A, 2, 0, 3), {});
  EXPECT_NEAR(cholesky.pivot_ratio() / 0x1p-20, 1.0, 1e-6);
}

TEST(Solve, MisuseIsALogicError) {
  EXPECT_THROW(SubstructuredCholesky(MPI_COMM_SELF, 0, 3), std::logic_error);
  EXPECT_THROW(SubstructuredCholesky(MPI_COMM_SELF, 17, 3), std::logic_error);
  SubstructuredCholesky cholesky(MPI_COMM_SELF, 2, 3);
  std::vector<double> x(6, 1.0);
  EXPECT_THROW(cholesky.solve(x.data()), std::logic_error);
  EXPECT_THROW(cholesky.factor(BlockTridiagonal(2, 4), {}), std::logic_error);
  EXPECT_THROW(cholesky.factor(BlockTridiagonal(2, 3), std::vector<char>(5)), std::logic_error);
}

TEST(Solve, NoNodesAtAll) {
  SubstructuredCholesky cholesky(MPI_COMM_SELF, 2, 0);
  cholesky.factor(BlockTridiagonal(2, 0), {});
  EXPECT_NO_THROW(cholesky.solve(nullptr, 3));
  EXPECT_EQ(cholesky.pivot_ratio(), 1.0);
}

TEST(BlockTridiagonalTest, CombinesEntryByEntry) {
  const BlockTridiagonal A = test::slice(test::random_spd(3, 4, 1.0, 20), 3, 0, 4);
  const BlockTridiagonal B = test::slice(test::random_spd(3, 4, 1.0, 21), 3, 0, 4);
  BlockTridiagonal C = test::slice(test::random_spd(3, 4, 1.0, 22), 3, 0, 4);
  const BlockTridiagonal old = C;
  C.combine(2.0, A, -3.0, B, 0.5, C);
  for (std::size_t i = 0; i < C.diagonal.size(); ++i) {
    EXPECT_NEAR(C.diagonal[i], 2.0 * A.diagonal[i] - 3.0 * B.diagonal[i] + 0.5 * old.diagonal[i], 1e-14);
    EXPECT_NEAR(C.upper[i], 2.0 * A.upper[i] - 3.0 * B.upper[i] + 0.5 * old.upper[i], 1e-14);
  }
  EXPECT_THROW(C.combine(1.0, A, 1.0, B, 1.0, BlockTridiagonal(3, 5)), std::logic_error);
}

TEST(BlockTridiagonalTest, RefusesEntriesOutsideTheBand) {
  base::Handle<Mat> A;
  base::check(MatCreateSeqAIJ(PETSC_COMM_SELF, 8, 8, 8, nullptr, A.out()));
  base::check(MatSetValue(A, 0, 3, 1.5, INSERT_VALUES));
  base::check(MatSetValue(A, 0, 7, 0.0, INSERT_VALUES));
  base::check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  base::check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  const BlockTridiagonal read = BlockTridiagonal::from(A, 2);
  EXPECT_EQ(read.nodes, 4);
  EXPECT_EQ(read.upper[2], 1.5);  // row 0, column 1 of the block that couples node 0 to node 1
  EXPECT_THROW(BlockTridiagonal::from(A, 3), std::logic_error);
  base::check(MatSetValue(A, 0, 7, 1.0, INSERT_VALUES));
  base::check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  base::check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  EXPECT_THROW(BlockTridiagonal::from(A, 2), std::logic_error);
}

}  // namespace
