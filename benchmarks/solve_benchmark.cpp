// The time per unknown of the beam's linear solves: this code's factorisation beside PETSc's Cholesky in natural
// ordering, on the same matrix. Also under mpirun (PETSc's part is left out then):
//   mpirun -n 2 build/benchmarks/solve_benchmark
// The matrix: a bridge of 30 m spans on rigid supports, ten cubic beam elements a span, A = a^2 M + K with a = 2,000
// 1/s (a step of 1 ms), or a = 0. Every solve starts with the copy of its right-hand side, as PETSc's out-of-place
// solve does.

#include <benchmark/benchmark.h>
#include <mpi.h>
#include <petscmat.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "traverse/base/petsc.hpp"
#include "traverse/solve/block_tridiagonal.hpp"

namespace {

using traverse::base::check;
using traverse::base::Handle;
using traverse::solve::BlockTridiagonal;
using traverse::solve::SubstructuredCholesky;

constexpr int elements_a_span = 10;

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

/// Entry (i, j) of an element's a^2 M + K; its unknowns: deflection and rotation at the left, at the right.
double element_entry(double shift, int i, int j) {
  constexpr double length = 3.0;                // m
  constexpr double bending_stiffness = 2.5e10;  // N m^2
  constexpr double mass = 1e4;                  // kg/m
  constexpr std::array<std::array<double, 4>, 4> stiffness = {
      {{12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}}};
  constexpr std::array<std::array<double, 4>, 4> inertia = {
      {{156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}}};
  const auto r = static_cast<std::size_t>(i);
  const auto c = static_cast<std::size_t>(j);
  const double rotations = (i % 2 == 1 ? length : 1.0) * (j % 2 == 1 ? length : 1.0);
  return rotations * (bending_stiffness / (length * length * length) * stiffness[r][c] +
                      shift * shift * mass * length / 420.0 * inertia[r][c]);
}

struct Bridge {
  BlockTridiagonal matrix;
  std::vector<char> fixed;
};

/// This rank's nodes [begin, begin + nodes) of a bridge with one node more on either side. A node's unknowns beyond
/// deflection and rotation are chains of springs.
Bridge bridge(int block, int begin, int nodes, bool last, double shift) {
  Bridge result{BlockTridiagonal(block, nodes), std::vector<char>(static_cast<std::size_t>(nodes * block), 0)};
  for (int node = 0; node < nodes; ++node) {
    double* diagonal = result.matrix.diagonal.data() + static_cast<std::ptrdiff_t>(node) * block * block;
    double* upper = result.matrix.upper.data() + static_cast<std::ptrdiff_t>(node) * block * block;
    for (int j = 0; j < block; ++j) {
      for (int i = 0; i < block; ++i) {
        const bool bending = i < 2 && j < 2;
        if (bending) diagonal[j * block + i] = element_entry(shift, i, j) + element_entry(shift, i + 2, j + 2);
        if (bending) upper[j * block + i] = element_entry(shift, i, j + 2);
        if (!bending && i == j) diagonal[j * block + i] = 4e9;
        if (!bending && i == j) upper[j * block + i] = -1.5e9;
        if (last && node + 1 == nodes) upper[j * block + i] = 0.0;
      }
    }
    if ((begin + node) % elements_a_span == 0) result.fixed[static_cast<std::size_t>(node * block)] = 1;
  }
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

Handle<Mat> petsc_matrix(const Bridge& parts) {
  const int block = parts.matrix.block;
  const PetscInt rows = static_cast<PetscInt>(parts.fixed.size());
  Handle<Mat> matrix;
  check(MatCreateSeqSBAIJ(PETSC_COMM_SELF, 1, rows, rows, 2 * block, nullptr, matrix.out()));
  for (PetscInt row = 0; row < rows; ++row) {
    const PetscInt node = row / block;
    for (PetscInt column = row; column < std::min<PetscInt>(rows, (node + 2) * block); ++column) {
      const std::vector<double>& blocks = column / block == node ? parts.matrix.diagonal : parts.matrix.upper;
      double value = blocks[static_cast<std::size_t>((node * block + column % block) * block + row % block)];
      if (parts.fixed[static_cast<std::size_t>(row)] != 0 || parts.fixed[static_cast<std::size_t>(column)] != 0) {
        value = row == column ? 1.0 : 0.0;
      }
      check(MatSetValue(matrix, row, column, value, INSERT_VALUES));
    }
  }
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  return matrix;
}

/// Arguments: unknowns, block size, shift in 1/s.
void petsc_cholesky(benchmark::State& state) {
  const int unknowns = static_cast<int>(state.range(0));
  const int block = static_cast<int>(state.range(1));
  const Bridge parts = bridge(block, 0, unknowns / block, true, static_cast<double>(state.range(2)));
  const Handle<Mat> matrix = petsc_matrix(parts);
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
  PetscFinalize();
  return EXIT_SUCCESS;
}
