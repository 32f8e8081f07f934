// Solves in windows and with a right-hand side written on the way, over ranks in many parts.

#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "solve/block_tridiagonal.hpp"
#include "support/random_bands.hpp"

namespace {

using namespace traverse;
using solve::SubstructuredCholesky;

constexpr int margin = 30;  // nodes: enough for random_band with shift 10

/// As many nodes on every rank, but for the ranks told to be empty.
struct Problem {
  Problem(int block_size, int nodes_a_rank, double shift, int empty_rank = -1) : block(block_size) {
    int rank = 0, size = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    for (int r = 0; r < size; ++r) {
      const int count = r == empty_rank ? 0 : nodes_a_rank;
      if (r < rank) begin += count;
      if (r == rank) nodes = count;
      whole += count;
    }
    cholesky.emplace(MPI_COMM_WORLD, block, nodes);
    cholesky->factor(test::random_band(block, begin, nodes, whole, shift), {});
    alone.emplace(MPI_COMM_SELF, block, whole);
    alone->factor(test::random_band(block, 0, whole, whole, shift), {});
  }
  Eigen::VectorXd load(int first, int past) const { return test::load_at(block, begin, nodes, first, past); }
  /// This rank's entries of the solution on one rank.
  Eigen::VectorXd expected(int first, int past) const {
    Eigen::VectorXd x = test::load_at(block, 0, whole, first, past);
    alone->solve(x.data());
    return x.segment(Eigen::Index{begin} * block, Eigen::Index{nodes} * block);
  }

  int block, begin = 0, nodes = 0, whole = 0;
  std::optional<SubstructuredCholesky> cholesky, alone;
};

double largest(const Eigen::VectorXd& x) { return x.size() == 0 ? 0.0 : x.cwiseAbs().maxCoeff(); }

TEST(SolveOverRanksInParts, IsTheSolutionOfOneRank) {
  for (int block : {1, 2}) {
    for (int nodes : {40, 700, 33'000}) {
      for (double shift : {10.0, 0.01}) {
        for (int empty : {-1, 0, 1}) {
          if (nodes > 700 && (block != 2 || empty == 0)) continue;
          const Problem problem(block, nodes, shift, empty);
          const Eigen::VectorXd expected = problem.expected(0, problem.whole);
          test::CopyingFiller filler(problem.load(0, problem.whole), block);
          Eigen::MatrixXd x = problem.load(0, problem.whole).replicate(1, 9);
          problem.cholesky->solve(filler.x.data(), filler);
          problem.cholesky->solve(x.data(), 9);
          const double bound = (shift > 1.0 ? 1e-14 : 1e-10) * std::max(1.0, largest(expected));
          EXPECT_LT(largest(filler.x - expected), bound) << block << " " << nodes << " " << shift << " " << empty;
          EXPECT_EQ(filler.times, std::vector<int>(static_cast<std::size_t>(problem.nodes), 1));
          for (int c = 0; c < 9; ++c) EXPECT_LT(largest(x.col(c) - expected), bound) << c;
        }
      }
    }
  }
}

// Windows inside a rank, up to and across the cuts, over all, and nowhere on some ranks.
TEST(SolveOverRanksInAWindow, IsThePlainSolutionInside) {
  for (int nodes : {300, 33'000}) {
    for (int empty : {-1, 0, 1}) {
      const Problem problem(2, nodes, 10.0, empty);
      const int cut = nodes;
      for (const auto& [first, past] : std::vector<std::pair<int, int>>{{0, 100},
                                                                        {cut - 120, cut},
                                                                        {cut - 121, cut + 1},
                                                                        {cut - 1, cut + 120},
                                                                        {cut, cut + 120},
                                                                        {cut - 80, cut + 90},
                                                                        {cut / 2 - 70, cut / 2 + 77},
                                                                        {0, problem.whole},
                                                                        {100, problem.whole}}) {
        if (past > problem.whole) continue;
        const int load_first = first == 0 ? 0 : first + margin;
        const int load_past = past == problem.whole ? past : past - margin;
        const int mine_first = std::clamp(first - problem.begin, 0, problem.nodes);
        const int mine_past = std::clamp(past - problem.begin, 0, problem.nodes);
        const Eigen::Index rows = 2 * Eigen::Index{mine_past - mine_first};
        const Eigen::VectorXd b = problem.load(load_first, load_past);
        const Eigen::VectorXd expected = problem.expected(load_first, load_past).segment(2 * mine_first, rows);

        test::CopyingFiller filler(b, 2);
        problem.cholesky->solve_window(filler.x.data(), mine_first, mine_past, filler);
        EXPECT_LT(largest(filler.x.segment(2 * mine_first, rows) - expected), 1e-15) << first << " to " << past;
        for (int node = 0; node < problem.nodes; ++node) {
          const bool inside = mine_first <= node && node < mine_past;
          ASSERT_EQ(filler.times[static_cast<std::size_t>(node)], inside ? 1 : 0) << node;
          ASSERT_EQ(std::isnan(filler.x[2 * Eigen::Index{node}]), !inside) << node;
        }
        for (int columns : {1, 3, 9}) {
          Eigen::MatrixXd local = b.segment(2 * mine_first, rows).replicate(1, columns);
          problem.cholesky->solve_local(local.data(), columns, mine_first, mine_past);
          for (int c = 0; c < columns; ++c)
            EXPECT_LT(largest(local.col(c) - expected), 1e-15) << first << " to " << past;
        }
      }
    }
  }
}

}  // namespace
