// Solves in many parts, with a right-hand side written on the way, and in windows, on one rank.

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "base/petsc.hpp"
#include "solve/block_tridiagonal.hpp"
#include "support/random_bands.hpp"

namespace {

using namespace traverse;
using solve::BlockTridiagonal;
using solve::SubstructuredCholesky;

constexpr int margin = 30;  // nodes: enough for random_band with shift 10

struct Problem {
  Problem(int block, int nodes, double shift)
      : A(test::random_band(block, 0, nodes, nodes, shift)), cholesky(MPI_COMM_SELF, block, nodes) {
    cholesky.factor(A, {});
  }
  Eigen::VectorXd solution(Eigen::VectorXd b) const {
    cholesky.solve(b.data());
    return b;
  }
  BlockTridiagonal A;
  SubstructuredCholesky cholesky;
};

double largest(const Eigen::VectorXd& x) { return x.size() == 0 ? 0.0 : x.cwiseAbs().maxCoeff(); }

// Fill that dies out within a part, and fill that couples all separators.
TEST(SolveInParts, LeavesNoResidual) {
  for (int block : {1, 2, 3, 7}) {
    for (int nodes : {511, 512, 513, 1500, 12'345, 40'000}) {
      for (double shift : {10.0, 1e-4}) {
        if ((shift < 1.0 || nodes > 20'000) && block > 2) continue;
        const Problem problem(block, nodes, shift);
        const Eigen::VectorXd b = test::load_at(block, 0, nodes, 0, nodes);
        for (int columns : {1, 2, 4, 8, 15}) {
          Eigen::MatrixXd x = b.replicate(1, columns);
          for (int c = 0; c < columns; ++c) x.col(c) *= c + 1.0;
          problem.cholesky.solve(x.data(), columns);
          for (int c = 0; c < columns; ++c) {
            const double scale = largest(x.col(c)) * (4.0 * block + shift);
            EXPECT_LT(largest(test::product(problem.A, x.col(c)) - (c + 1.0) * b), 1e-14 * scale)
                << "block " << block << ", nodes " << nodes << ", shift " << shift << ", column " << c;
          }
        }
      }
    }
  }
}

// -u'' = 1 by second differences: u_i = i(n + 1 - i)/2; every part's fill reaches its middle.
TEST(SolveInParts, SecondDifferencesGiveTheParabola) {
  const int n = 40'000;
  BlockTridiagonal A(1, n);
  for (double& entry : A.diagonal) entry = 2.0;
  for (double& entry : A.upper) entry = -1.0;
  SubstructuredCholesky cholesky(MPI_COMM_SELF, 1, n);
  cholesky.factor(A, {});
  std::vector<double> x(n, 1.0);
  cholesky.solve(x.data());
  for (int i = 1; i <= n; ++i) EXPECT_NEAR(x[static_cast<std::size_t>(i - 1)] / (0.5 * i * (n + 1.0 - i)), 1.0, 1e-9);
}

TEST(SolveInParts, NotPositiveDefiniteNamesTheUnknown) {
  const int nodes = 9000;
  for (int node : {0, 4499, 4500, 4501, 8999}) {  // 4500: a separator
    BlockTridiagonal A = test::random_band(2, 0, nodes, nodes, 10.0);
    A.diagonal[static_cast<std::size_t>(node * 4 + 3)] = -1.0;
    SubstructuredCholesky cholesky(MPI_COMM_SELF, 2, nodes);
    try {
      cholesky.factor(A, {});
      ADD_FAILURE() << "no error for node " << node;
    } catch (const SolverError& error) {
      EXPECT_NE(std::string(error.what()).find("unknown " + std::to_string(2 * node + 1) + " "), std::string::npos)
          << error.what();
    }
  }
}

TEST(SolveInParts, PivotRatioSeesASeparator) {
  const int nodes = 9000;
  for (int node : {1, 4500}) {
    BlockTridiagonal A(2, nodes);
    for (std::size_t i = 0; i < A.diagonal.size(); i += 4) A.diagonal[i] = A.diagonal[i + 3] = 1.0;
    const auto at = static_cast<std::size_t>(node) * 4;
    A.diagonal[at + 1] = A.diagonal[at + 2] = 1.0 - 0x1p-21;  // the second pivot is 1 - (1 - e)^2 = 2e - e^2
    SubstructuredCholesky cholesky(MPI_COMM_SELF, 2, nodes);
    cholesky.factor(A, {});
    EXPECT_NEAR(cholesky.pivot_ratio() / 0x1p-20, 1.0, 1e-6) << node;
  }
}

TEST(SolveWithFiller, AsksForEveryNodeOnceAndSolvesTheSame) {
  for (int block : {1, 2, 3, 6}) {
    for (int nodes : {1, 2, 3, 5, 100, 700, 9000, 40'000}) {
      if (nodes > 9000 && block != 2) continue;
      const Problem problem(block, nodes, 0.5);
      const Eigen::VectorXd b = test::load_at(block, 0, nodes, 0, nodes);
      test::CopyingFiller filler(b, block);
      problem.cholesky.solve(filler.x.data(), filler);
      EXPECT_EQ(filler.times, std::vector<int>(static_cast<std::size_t>(nodes), 1)) << nodes;
      EXPECT_LE(filler.longest, 256);
      const Eigen::VectorXd expected = problem.solution(b);
      EXPECT_LE(largest(filler.x - expected), 1e-13 * largest(expected)) << nodes;
    }
  }
}

struct Window {
  int first;
  int past;
};

/// Windows at the ends and across middles (5,000, 15,000, ...) and separators (10,000, 20,000, 30,000) of 40,000 nodes.
constexpr int window_nodes = 40'000;
const std::vector<Window> windows = {
    {0, 40'000},      {0, 70},          {0, 5000},        {39'930, 40'000}, {18'000, 40'000}, {100, 200},
    {4960, 5040},     {9950, 10'050},   {10'000, 10'100}, {9900, 10'000},   {10'001, 10'101}, {19'900, 20'100},
    {2000, 38'000},   {12'000, 12'101}, {19'999, 31'000}, {5000, 5100},     {4900, 5000},     {4900, 5001},
    {19'900, 20'000}, {20'000, 20'100}, {9'000, 20'000},  {20'000, 30'000}, {29'900, 30'100}, {10'000, 30'001}};

TEST(SolveInAWindow, IsThePlainSolutionInside) {
  for (int block : {2, 3}) {
    const int nodes = window_nodes;
    const Problem problem(block, nodes, 10.0);
    for (const Window& window : windows) {
      const int first = window.first == 0 ? 0 : window.first + margin;
      const int past = window.past == nodes ? nodes : window.past - margin;
      const Eigen::VectorXd b = test::load_at(block, 0, nodes, first, past);
      const Eigen::VectorXd expected = problem.solution(b);
      const Eigen::Index begin = Eigen::Index{window.first} * block;
      const Eigen::Index rows = Eigen::Index{window.past - window.first} * block;

      test::CopyingFiller filler(b, block);
      problem.cholesky.solve_window(filler.x.data(), window.first, window.past, filler);
      EXPECT_LT(largest(filler.x.segment(begin, rows) - expected.segment(begin, rows)), 1e-15)
          << window.first << " to " << window.past;
      for (int node = 0; node < nodes; ++node) {
        const bool inside = window.first <= node && node < window.past;
        ASSERT_EQ(filler.times[static_cast<std::size_t>(node)], inside ? 1 : 0) << node;
        ASSERT_EQ(std::isnan(filler.x[Eigen::Index{node} * block]), !inside) << node;
      }

      for (int columns : {1, 2, 3, 8, 13}) {
        Eigen::MatrixXd local = b.segment(begin, rows).replicate(1, columns);
        for (int c = 0; c < columns; ++c) local.col(c) *= c + 1.0;
        problem.cholesky.solve_local(local.data(), columns, window.first, window.past);
        for (int c = 0; c < columns; ++c) {
          EXPECT_LT(largest(local.col(c) - (c + 1.0) * expected.segment(begin, rows)), 1e-14)
              << window.first << " to " << window.past << ", column " << c;
        }
      }
    }
  }
}

// Without a margin the window's ends are felt, as the response there is not small.
TEST(SolveInAWindow, NeedsItsMargin) {
  const Problem problem(2, 9000, 10.0);
  const Eigen::VectorXd b = test::load_at(2, 0, 9000, 100, 200);
  const Eigen::VectorXd expected = problem.solution(b);
  test::CopyingFiller filler(b, 2);
  problem.cholesky.solve_window(filler.x.data(), 100, 200, filler);
  EXPECT_GT(largest(filler.x.segment(200, 200) - expected.segment(200, 200)), 1e-6);
}

TEST(SolveInAWindow, SmallMatricesToo) {
  for (int nodes : {1, 2, 3, 4, 5, 6, 90}) {
    const Problem problem(2, nodes, 10.0);
    const Eigen::VectorXd b = test::load_at(2, 0, nodes, 0, nodes);
    test::CopyingFiller whole(b, 2);
    problem.cholesky.solve_window(whole.x.data(), 0, nodes, whole);
    EXPECT_LT(largest(whole.x - problem.solution(b)), 1e-15);
    for (int first = 0; first < nodes; ++first) {
      for (int past = first; past <= nodes; ++past) {  // only that it stays inside
        test::CopyingFiller filler(b, 2);
        problem.cholesky.solve_window(filler.x.data(), first, past, filler);
        for (int node = 0; node < nodes; ++node) {
          EXPECT_EQ(std::isnan(filler.x[2 * node]), node < first || node >= past);
        }
      }
    }
  }
}

TEST(SolveInAWindow, BeyondTheNodesIsALogicError) {
  const Problem problem(2, 10, 10.0);
  std::vector<double> x(40);
  EXPECT_THROW(problem.cholesky.solve_local(x.data(), 1, -1, 3), std::logic_error);
  EXPECT_THROW(problem.cholesky.solve_local(x.data(), 1, 5, 11), std::logic_error);
  EXPECT_THROW(problem.cholesky.solve_local(x.data(), 1, 5, 4), std::logic_error);
  EXPECT_NO_THROW(problem.cholesky.solve_local(x.data(), 1, 5, 5));
}

}  // namespace
