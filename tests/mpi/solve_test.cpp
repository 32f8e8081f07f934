// The factorisation over ranks: the solution is that of the whole dense matrix, however the nodes are cut.

#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "base/petsc.hpp"
#include "solve/block_tridiagonal.hpp"
#include "support/random_blocks.hpp"
#include "traverse/base/error.hpp"

namespace {

using namespace traverse;
using solve::BlockTridiagonal;
using solve::SubstructuredCholesky;

int world_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int world_size() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// The nodes of each rank: the pattern, repeated over the ranks.
class Cut {
 public:
  explicit Cut(const std::vector<int>& pattern) {
    for (int r = 0; r < world_size(); ++r) counts_.push_back(pattern[static_cast<std::size_t>(r) % pattern.size()]);
  }
  int nodes() const { return counts_[static_cast<std::size_t>(world_rank())]; }
  int begin() const { return std::accumulate(counts_.begin(), counts_.begin() + world_rank(), 0); }
  int whole() const { return std::accumulate(counts_.begin(), counts_.end(), 0); }

 private:
  std::vector<int> counts_;
};

const std::vector<std::vector<int>> patterns = {{5, 4}, {1},          {2},       {3, 1},       {1, 6},  {0, 7},
                                                {6, 0}, {4, 0, 1, 3}, {0, 0, 5}, {20, 21, 19}, {2, 30}, {1, 0, 9}};

/// Largest error of this rank's solution relative to the largest entry of the whole one.
double error(const Eigen::MatrixXd& A, int block, const Cut& cut, const std::vector<char>& fixed, int columns) {
  const Eigen::MatrixXd b = test::random_matrix(A.rows(), columns, 99);
  const Eigen::MatrixXd expected = test::dense_solution(A, fixed, b);
  const Eigen::Index begin = cut.begin() * block;
  const Eigen::Index rows = cut.nodes() * block;
  std::vector<char> mine;
  if (!fixed.empty()) mine.assign(fixed.begin() + begin, fixed.begin() + begin + rows);

  SubstructuredCholesky cholesky(MPI_COMM_WORLD, block, cut.nodes());
  cholesky.factor(test::slice(A, block, cut.begin(), cut.nodes()), mine);
  Eigen::MatrixXd x = b.middleRows(begin, rows);
  cholesky.solve(x.data(), columns);
  if (rows == 0) return 0.0;
  return (x - expected.middleRows(begin, rows)).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

TEST(SolveOverRanks, SolvesAsTheDenseMatrix) {
  for (const std::vector<int>& pattern : patterns) {
    const Cut cut(pattern);
    if (cut.whole() == 0) continue;
    for (int block : {1, 2, 3, 4, 7}) {
      const Eigen::MatrixXd A = test::random_spd(block, cut.whole(), 0.1, 1);
      for (int columns : {1, 2, 3, 4, 7}) {
        EXPECT_LT(error(A, block, cut, {}, columns), 1e-12)
            << "cut " << testing::PrintToString(pattern) << ", block " << block << ", columns " << columns;
      }
    }
  }
}

TEST(SolveOverRanks, FixedUnknownsAlsoAtTheCuts) {
  for (const std::vector<int>& pattern : patterns) {
    const Cut cut(pattern);
    if (cut.whole() == 0) continue;
    for (int block = 1; block <= 4; ++block) {
      const int unknowns = cut.whole() * block;
      const Eigen::MatrixXd A = test::random_spd(block, cut.whole(), 0.1, 2);
      for (unsigned seed = 0; seed < 6; ++seed) {
        EXPECT_LT(error(A, block, cut, test::random_fixed(unknowns, seed), 2), 1e-12);
      }
      EXPECT_LT(error(A, block, cut, std::vector<char>(static_cast<std::size_t>(unknowns), 1), 2), 1e-15);
    }
  }
}

TEST(SolveOverRanks, IsolatedSpansAlsoAtTheCuts) {
  for (const std::vector<int>& pattern : patterns) {
    const Cut cut(pattern);
    for (int step : {1, 2, 3}) {
      if (cut.whole() == 0) continue;
      Eigen::MatrixXd A = test::random_spd(2, cut.whole(), 0.1, 3);
      for (int node = 0; node + 1 < cut.whole(); node += step) test::disconnect(A, 2, node);
      EXPECT_LT(error(A, 2, cut, {}, 3), 1e-12);
    }
  }
}

// With a large shift the separators' fill is cut off long before the middle; what is dropped is below rounding.
TEST(SolveOverRanks, TruncatedFillCostsNothing) {
  const Cut cut({45, 38});
  for (double shift : {1.0, 10.0, 1000.0}) {
    EXPECT_LT(error(test::random_spd(2, cut.whole(), shift, 4), 2, cut, {}, 5), 1e-14) << shift;
    EXPECT_LT(error(test::random_spd(3, cut.whole(), shift, 5), 3, cut, {}, 5), 1e-14) << shift;
  }
}

// -u'' = 1 by second differences, u = 0 at both ends: u_i = i(n + 1 - i)/2; the fill reaches the middle.
TEST(SolveOverRanks, SecondDifferencesGiveTheParabola) {
  const Cut cut({1500, 1001});
  BlockTridiagonal A(1, cut.nodes());
  for (double& entry : A.diagonal) entry = 2.0;
  for (double& entry : A.upper) entry = -1.0;
  SubstructuredCholesky cholesky(MPI_COMM_WORLD, 1, cut.nodes());
  cholesky.factor(A, {});
  std::vector<double> x(static_cast<std::size_t>(cut.nodes()), 1.0);
  cholesky.solve(x.data());
  for (int local = 0; local < cut.nodes(); ++local) {
    const double i = cut.begin() + local + 1.0;
    EXPECT_NEAR(x[static_cast<std::size_t>(local)] / (0.5 * i * (cut.whole() + 1 - i)), 1.0, 1e-10);
  }
  double smallest = cholesky.pivot_ratio();
  MPI_Allreduce(MPI_IN_PLACE, &smallest, 1, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
  EXPECT_EQ(smallest, cholesky.pivot_ratio());
  EXPECT_GT(smallest, 0.0);
  EXPECT_LT(smallest, 1e-2);  // the last separator keeps 1/(2 n) or so of its 2
}

TEST(SolveOverRanks, FactorsAgainWithOtherValues) {
  const Cut cut({20, 11});
  SubstructuredCholesky cholesky(MPI_COMM_WORLD, 2, cut.nodes());
  for (double shift : {100.0, 0.01, 1.0}) {
    const Eigen::MatrixXd A = test::random_spd(2, cut.whole(), shift, 7);
    const Eigen::MatrixXd b = test::random_matrix(A.rows(), 1, 8);
    const Eigen::MatrixXd expected = test::dense_solution(A, {}, b);
    Eigen::MatrixXd x = b.middleRows(cut.begin() * 2, cut.nodes() * 2);
    cholesky.factor(test::slice(A, 2, cut.begin(), cut.nodes()), {});
    cholesky.solve(x.data());
    EXPECT_LT((x - expected.middleRows(cut.begin() * 2, cut.nodes() * 2)).cwiseAbs().maxCoeff(),
              1e-12 * expected.cwiseAbs().maxCoeff());
  }
}

TEST(SolveOverRanks, EveryRankHearsOfABadPivot) {
  const Cut cut({3, 4});
  for (int unknown : {1, 6, 2 * cut.whole() - 4, 2 * cut.whole() - 1}) {  // 6: at the first cut
    if (unknown >= 2 * cut.whole()) continue;
    Eigen::MatrixXd A = 4.0 * Eigen::MatrixXd::Identity(2 * cut.whole(), 2 * cut.whole());
    A(unknown, unknown) = -1.0;
    SubstructuredCholesky cholesky(MPI_COMM_WORLD, 2, cut.nodes());
    try {
      cholesky.factor(test::slice(A, 2, cut.begin(), cut.nodes()), {});
      ADD_FAILURE() << "no error for unknown " << unknown;
    } catch (const SolverError& failure) {
      EXPECT_NE(std::string(failure.what()).find("unknown " + std::to_string(unknown) + " "), std::string::npos)
          << failure.what();
    }
    cholesky.factor(test::slice(Eigen::MatrixXd(A.cwiseAbs()), 2, cut.begin(), cut.nodes()), {});  // and goes on
  }
}

// Not a number in the coupling across a cut, which only the separators see.
TEST(SolveOverRanks, EveryRankHearsOfANumberThatIsNone) {
  const Cut cut({3, 4});
  if (world_size() == 1) GTEST_SKIP() << "one rank has no cut";
  BlockTridiagonal A =
      test::slice(Eigen::MatrixXd::Identity(2 * cut.whole(), 2 * cut.whole()), 2, cut.begin(), cut.nodes());
  if (world_rank() == 0) A.upper.back() = std::nan("");
  SubstructuredCholesky cholesky(MPI_COMM_WORLD, 2, cut.nodes());
  EXPECT_THROW(cholesky.factor(A, {}), SolverError);
}

TEST(SolveOverRanks, ReadsADistributedMatrix) {
  for (int block : {1, 2, 3}) {
    const Cut cut({4, 0, 3, 1});
    const Eigen::MatrixXd A = test::random_spd(block, cut.whole(), 0.1, 11);
    base::Handle<Mat> matrix;
    const PetscInt rows = cut.nodes() * block;
    base::check(MatCreateAIJ(PETSC_COMM_WORLD, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE, 3 * block, nullptr,
                             3 * block, nullptr, matrix.out()));
    for (PetscInt row = cut.begin() * block; row < cut.begin() * block + rows; ++row) {
      const PetscInt node = row / block;
      for (PetscInt column = std::max(0, (node - 1) * block);
           column < std::min((node + 2) * block, cut.whole() * block); ++column) {
        base::check(MatSetValue(matrix, row, column, A(row, column), INSERT_VALUES));
      }
    }
    base::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    base::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    const BlockTridiagonal read = BlockTridiagonal::from(matrix, block);
    const BlockTridiagonal expected = test::slice(A, block, cut.begin(), cut.nodes());
    EXPECT_EQ(read.nodes, cut.nodes());
    EXPECT_EQ(read.diagonal, expected.diagonal);
    EXPECT_EQ(read.upper, expected.upper);
  }
}

}  // namespace
