// Factors whose numbers are kept once where spans repeat, on any number of ranks: their solutions against those in long
// double, beside the errors of factors that are kept whole because no two entries are quite the same.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/equal_spans.hpp"

namespace {

using namespace traverse;

struct Outcome {
  double error = 0.0;   // of the solution, relative to its largest deflection, or rotation
  double stored = 0.0;  // numbers kept an unknown
};

/// On all ranks, each with as many nodes as the others or one more.
Outcome solve_and_compare(const test::EqualSpans& bridge, int columns) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const test::EqualSpans::Matrix whole = bridge.matrix();
  const int b = whole.A.block, begin = whole.A.nodes * rank / ranks, past = whole.A.nodes * (rank + 1) / ranks;
  const auto part = [&](const auto& of, int size) {
    return std::vector(of.begin() + begin * size, of.begin() + past * size);
  };
  solve::BlockTridiagonal A(b, past - begin);
  A.diagonal = part(whole.A.diagonal, b * b);
  A.upper = part(whole.A.upper, b * b);
  const std::vector<double> load = test::random_load(whole.fixed),
                            expected = test::solution_in_long_double(whole, load);
  solve::SubstructuredCholesky cholesky(MPI_COMM_WORLD, b, past - begin);
  cholesky.factor(A, part(whole.fixed, b));
  std::vector<double> x;
  for (int column = 0; column < columns; ++column) {
    const std::vector<double> own = part(load, b);
    x.insert(x.end(), own.begin(), own.end());
  }
  cholesky.solve(x.data(), columns);
  std::array<double, 2> largest{}, off{};
  const int rows = (past - begin) * b;
  for (int i = 0; i < static_cast<int>(expected.size()); ++i) {
    double& its = largest[i % b == 0 ? 0 : 1];
    its = std::max(its, std::abs(expected[static_cast<std::size_t>(i)]));
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const int row = static_cast<int>(i) % rows;
    double& its = off[row % b == 0 ? 0 : 1];
    its = std::max(its, std::abs(x[i] - expected[static_cast<std::size_t>(begin * b + row)]));
  }
  Outcome result{std::max(off[0] / largest[0], off[1] / largest[1]),
                 static_cast<double>(cholesky.stored_numbers()) / rows};
  MPI_Allreduce(MPI_IN_PLACE, &result.error, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return result;
}

/// Both with a mass term and without.
void expect_shared(test::EqualSpans bridge, double most_stored, const char* name) {
  for (double shift : {2000.0, 0.0}) {
    bridge.shift = shift;
    bridge.jitter = 1e-15;
    const Outcome apart = solve_and_compare(bridge, 1);
    bridge.jitter = 0.0;
    for (int columns : {1, 2, 5}) {
      const Outcome shared = solve_and_compare(bridge, columns);
      EXPECT_LT(shared.error, 1e-12) << name << ", shift " << shift << ", columns " << columns;
      EXPECT_LT(shared.error, 4.0 * apart.error) << name << ", shift " << shift << ", columns " << columns;
      EXPECT_LT(shared.stored, most_stored * apart.stored) << name << ", shift " << shift;
      if (columns > 1) continue;
      const std::string which = std::string(name) + (shift > 0.0 ? "_dynamic_" : "_static_");
      testing::Test::RecordProperty(which + "error", fmt::format("{:.1e}", shared.error));
      testing::Test::RecordProperty(which + "error_apart", fmt::format("{:.1e}", apart.error));
    }
  }
}

TEST(FactorsThatRepeat, OnEqualSpans) { expect_shared({.spans = 2000}, 0.4, "equal"); }
TEST(FactorsThatRepeat, WithOneOddSpan) { expect_shared({.spans = 2000, .odd_span = 701}, 0.5, "odd"); }
TEST(FactorsThatRepeat, WithElasticSupportsAtEveryOtherPier) {
  expect_shared({.spans = 2000, .elastic = true}, 0.4, "elastic");
}
TEST(FactorsThatRepeat, WithHinges) {
  expect_shared({.spans = 3000, .elements = 6, .spans_to_hinge = 3}, 0.5, "hinges");
}

}  // namespace
