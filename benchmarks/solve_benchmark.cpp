// The time per unknown of the beam's linear solves: this code's factorisation beside PETSc's Cholesky in natural
// ordering, on the same matrix. Also under mpirun (PETSc's part is left out then):
//   mpirun -n 2 build/benchmarks/solve_benchmark
// The matrix is that of bridge_matrix.hpp. Every solve starts with the copy of its right-hand side, as PETSc's
// out-of-place solve does.

#include <benchmark/benchmark.h>
#include <mpi.h>
#include <petscmat.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "base/petsc.hpp"
#include "bridge_matrix.hpp"
#include "solve/block_tridiagonal.hpp"

namespace {

using traverse::base::check;
using traverse::base::Handle;
using namespace traverse::benchmarks;
using traverse::solve::SubstructuredCholesky;

int ranks() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

int rank() {
  int result = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &result);
  return result;
}

/// The time of a run divided by its unknowns.
void report(benchmark::State& state, double unknowns) {
  state.counters["per_unknown"] =
      benchmark::Counter(unknowns, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

struct Problem {
  Problem(int block, int unknowns, double shift)
      : nodes(unknowns / block / ranks()),
        parts(bridge(block, rank() * nodes, nodes, rank() + 1 == ranks(), shift)),
        cholesky(MPI_COMM_WORLD, block, nodes) {
    cholesky.factor(parts.matrix, parts.fixed);
  }
  int nodes;
  Bridge parts;
  SubstructuredCholesky cholesky;
};

/// Arguments: unknowns, columns, block size, shift in 1/s.
void solve(benchmark::State& state) {
  const int unknowns = static_cast<int>(state.range(0));
  const int columns = static_cast<int>(state.range(1));
  const Problem problem(static_cast<int>(state.range(2)), unknowns, static_cast<double>(state.range(3)));
  const std::vector<double> b(problem.parts.fixed.size() * static_cast<std::size_t>(columns), 1.0);
  std::vector<double> x(b.size());
  for (auto _ : state) {
    std::copy(b.begin(), b.end(), x.begin());
    problem.cholesky.solve(x.data(), columns);
    benchmark::ClobberMemory();
  }
  report(state, static_cast<double>(unknowns) * columns);
}

void factor(benchmark::State& state) {
  const int unknowns = static_cast<int>(state.range(0));
  Problem problem(static_cast<int>(state.range(1)), unknowns, static_cast<double>(state.range(2)));
  for (auto _ : state) problem.cholesky.factor(problem.parts.matrix, problem.parts.fixed);
  state.counters["pivot_ratio"] = problem.cholesky.pivot_ratio();
  report(state, unknowns);
}

/// Arguments: unknowns, block size, shift in 1/s.
void petsc_cholesky(benchmark::State& state) {
  const int unknowns = static_cast<int>(state.range(0));
  const int block = static_cast<int>(state.range(1));
  const Bridge parts = bridge(block, 0, unknowns / block, true, static_cast<double>(state.range(2)));
  const Handle<Mat> matrix = symmetric_matrix(parts);
  Handle<Mat> factored;
  Handle<IS> rows;
  Handle<IS> columns;
  MatFactorInfo info;
  check(MatFactorInfoInitialize(&info));
  check(MatGetOrdering(matrix, MATORDERINGNATURAL, rows.out(), columns.out()));
  check(MatGetFactor(matrix, MATSOLVERPETSC, MAT_FACTOR_CHOLESKY, factored.out()));
  check(MatCholeskyFactorSymbolic(factored, matrix, rows, &info));
  check(MatCholeskyFactorNumeric(factored, matrix, &info));
  Handle<Vec> b;
  Handle<Vec> x;
  check(MatCreateVecs(matrix, x.out(), b.out()));
  check(VecSet(b, 1.0));
  for (auto _ : state) check(MatSolve(factored, b, x));
  report(state, unknowns);
}

constexpr std::array<int, 6> sizes = {100, 1000, 10'000, 100'000, 200'000, 1'000'000};
constexpr std::array<int, 2> shifts = {2000, 0};

void add(const char* name, void (*body)(benchmark::State&), const std::vector<std::int64_t>& arguments) {
  // As many runs on every rank: all take part in each solve.
  const std::int64_t runs = std::max<std::int64_t>(20, 20'000'000 / arguments[0]);
  benchmark::RegisterBenchmark(name, body)->Args(arguments)->Iterations(runs)->UseRealTime();
}

void add_all() {
  for (int size : sizes) {
    for (int shift : shifts) {
      for (int columns : {1, 4}) add("solve/unknowns/columns/block/shift", solve, {size, columns, 2, shift});
      if (ranks() == 1) add("petsc_cholesky/unknowns/block/shift", petsc_cholesky, {size, 2, shift});
      add("factor/unknowns/block/shift", factor, {size, 2, shift});
    }
  }
  for (int block : {3, 4, 6}) {
    const int size = 200'000 / (block * ranks()) * (block * ranks());
    for (int columns : {1, 4}) add("solve/unknowns/columns/block/shift", solve, {size, columns, block, 2000});
    if (ranks() == 1) add("petsc_cholesky/unknowns/block/shift", petsc_cholesky, {size, block, 2000});
    add("factor/unknowns/block/shift", factor, {size, block, 2000});
  }
}

class Silent : public benchmark::BenchmarkReporter {
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (PetscInitialize(&argc, &argv, nullptr, nullptr) != 0) return EXIT_FAILURE;
  add_all();
  Silent silent;
  if (rank() == 0) {
    benchmark::RunSpecifiedBenchmarks();
  } else {
    benchmark::RunSpecifiedBenchmarks(&silent);
  }
  (void)PetscFinalize();
  return EXIT_SUCCESS;
}
