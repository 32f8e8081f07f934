// Solving with the beam's factorisation on one core, beside PETSc's own Cholesky (natural ordering), LAPACK's band
// solver and MUMPS, all measured in turn in one run on the same matrix (bridge_matrix.hpp, a = 2,000 1/s); "kept whole"
// is ours where spans differ by rounding, so that the factor's numbers do not repeat:
//   build/benchmarks/beam_solver_benchmark [FILE.csv [LARGEST]]
// with up to LARGEST (1,000,000) unknowns; prints ns per unknown (medians, and the least) and ratios to ours;
// benchmarks/beam_solver_picture.py draws the file.
// Every solve starts from a right-hand side that is kept, so those in place copy it first, within their time.

#include <petscmat.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/petsc.hpp"
#include "bridge_matrix.hpp"
#include "solve/block_tridiagonal.hpp"

extern "C" {  // LAPACK's own names
// NOLINTBEGIN(readability-identifier-naming)
void dpbtrf_(const char* half, const int* rows, const int* above, double* band, const int* leading, int* info);
void dpbtrs_(const char* half, const int* rows, const int* above, const int* columns, const double* band,
             const int* leading, double* x, const int* leading_x, int* info);
// NOLINTEND(readability-identifier-naming)
}

namespace {

using namespace traverse;
using namespace traverse::benchmarks;
using base::check;
using base::Handle;

constexpr int block = 2;
constexpr std::array<int, 12> sizes = {20,     50,     100,     200,     500,     1000,
                                       10'000, 50'000, 100'000, 200'000, 500'000, 1'000'000};

/// The processor time of this thread, which leaves out what else the machine has to do.
double now() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double seconds(const std::function<void()>& work) {
  const double start = now();
  work();
  return now() - start;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Solver {
  std::string name;
  std::function<void()> solve;
  std::vector<double> times = {};  // s a solve
};

std::shared_ptr<solve::SubstructuredCholesky> factored(const Bridge& parts) {
  auto cholesky = std::make_shared<solve::SubstructuredCholesky>(PETSC_COMM_SELF, block, parts.matrix.nodes);
  cholesky->factor(parts.matrix, parts.fixed);
  return cholesky;
}

/// The same bridge with entries changed at random by some 1e-15, so that no numbers of the factor are kept once.
Bridge unequal(Bridge parts) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> number(-1e-15, 1e-15);
  for (std::size_t i = 0; i < parts.matrix.diagonal.size(); i += block * block)
    parts.matrix.diagonal[i] *= 1.0 + number(generator);
  return parts;
}

Solver ours(const std::string& name, const std::shared_ptr<solve::SubstructuredCholesky>& cholesky,
            const std::vector<double>& b) {
  return {name, [cholesky, &b, x = std::vector<double>(b.size())]() mutable {
            std::copy(b.begin(), b.end(), x.begin());
            cholesky->solve(x.data());
          }};
}

Solver lapack(const Bridge& parts, const std::vector<double>& b) {
  const int rows = static_cast<int>(b.size());
  const int above = 2 * block - 1;
  const int leading = above + 1;
  auto band = std::make_shared<std::vector<double>>(b.size() * static_cast<std::size_t>(leading));
  for_upper_entries(parts, [&](PetscInt row, PetscInt column, double value) {
    if (column - row <= above) (*band)[static_cast<std::size_t>(column * leading + above + row - column)] = value;
  });
  int info = 0;
  dpbtrf_("U", &rows, &above, band->data(), &leading, &info);
  if (info != 0) throw std::runtime_error("dpbtrf failed");
  return {"LAPACK dpbtrs", [=, &b, x = std::vector<double>(b.size())]() mutable {
            std::copy(b.begin(), b.end(), x.begin());
            const int columns = 1;
            dpbtrs_("U", &rows, &above, &columns, band->data(), &leading, x.data(), &rows, &info);
          }};
}

struct Factored {
  Handle<Mat> matrix;
  Handle<Mat> factor;
  Handle<Vec> b;
  Handle<Vec> x;
};

Solver petsc(const std::string& name, Handle<Mat> matrix, MatSolverType package) {
  auto kept = std::make_shared<Factored>();
  kept->matrix = std::move(matrix);
  Handle<IS> rows;
  Handle<IS> columns;
  MatFactorInfo info;
  check(MatFactorInfoInitialize(&info));
  check(MatGetOrdering(kept->matrix, MATORDERINGNATURAL, rows.out(), columns.out()));
  check(MatGetFactor(kept->matrix, package, MAT_FACTOR_CHOLESKY, kept->factor.out()));
  check(MatCholeskyFactorSymbolic(kept->factor, kept->matrix, rows, &info));
  check(MatCholeskyFactorNumeric(kept->factor, kept->matrix, &info));
  check(MatCreateVecs(kept->matrix, kept->x.out(), kept->b.out()));
  check(VecSet(kept->b, 1.0));
  return {name, [kept] { check(MatSolve(kept->factor, kept->b, kept->x)); }};
}

Handle<Mat> full_matrix(Mat symmetric) {
  Handle<Mat> matrix;
  check(MatConvert(symmetric, MATSEQAIJ, MAT_INITIAL_MATRIX, matrix.out()));
  return matrix;
}

std::vector<Solver> solvers(const Bridge& parts, const std::vector<double>& b) {
  std::vector<Solver> result;
  result.push_back(ours("traverse", factored(parts), b));
  result.push_back(ours("kept whole", factored(unequal(parts)), b));
  result.push_back(petsc("PETSc sbaij", symmetric_matrix(parts), MATSOLVERPETSC));
  result.push_back(petsc("PETSc aij", full_matrix(symmetric_matrix(parts)), MATSOLVERPETSC));
  result.push_back(lapack(parts, b));
#if defined(PETSC_HAVE_MUMPS)
  result.push_back(petsc("MUMPS", symmetric_matrix(parts), MATSOLVERMUMPS));
#endif
  return result;
}

/// Rounds in which each solver takes its turn: one solve to bring its numbers back into the caches, then some timed.
void measure(std::vector<Solver>& of, int unknowns) {
  constexpr int rounds = 15;
  for (int round = 0; round < rounds; ++round) {
    for (Solver& solver : of) {
      const int solves = solver.name == "MUMPS" ? 1 : std::max(5, 2'000'000 / unknowns);
      solver.solve();
      const double time = seconds([&] {
        for (int i = 0; i < solves; ++i) solver.solve();
      });
      solver.times.push_back(time / solves);
    }
  }
}

/// B/s read and written by copies between two halves of so many bytes.
double copy_bandwidth(std::size_t bytes) {
  std::vector<char> from(bytes / 2, 1), to(bytes / 2);
  const int copies = std::max(1, static_cast<int>(20'000'000 / bytes));
  std::vector<double> times;
  for (int round = 0; round < 15; ++round) {
    times.push_back(seconds([&] {
      for (int i = 0; i < copies; ++i) {
        std::memcpy(to.data(), from.data(), from.size());
        from[static_cast<std::size_t>(i) % from.size()] = to.back();
      }
    }));
  }
  return static_cast<double>(from.size() + to.size()) * copies / median(times);
}

/// s from one multiply-add to the next that needs it.
double multiply_add_latency() {
  constexpr int steps = 1'000'000;
  volatile double start = 1.0;
  std::vector<double> times;
  for (int round = 0; round < 15; ++round) {
    times.push_back(seconds([&] {
      const double factor = start;
      double y = start;
      for (int i = 0; i < steps; ++i) y = factor - factor * y;  // not to be known when compiling
      start = 1.0 + 0.0 * y;
    }));
  }
  return median(times) / steps;
}

void run(const char* file, int largest) {
  std::ofstream table;
  if (file != nullptr) table.open(file);
  table << "unknowns,solver,ns_per_unknown,ratio\n";
  const double latency = multiply_add_latency() * 1e9;
  std::printf("multiply-add after multiply-add: %.2f ns; one chain waits for 4 of them a node: %.2f ns an unknown\n",
              latency, 2.0 * latency);
#if !defined(PETSC_HAVE_MUMPS)
  std::printf("this PETSc has no MUMPS\n");
#endif
  std::printf("%10s  %-14s %14s %9s %9s\n", "unknowns", "", "ns an unknown", "of ours", "least");
  for (int unknowns : sizes) {
    if (unknowns > largest) break;
    const Bridge parts = bridge(block, 0, unknowns / block, true, 2000.0);
    const std::vector<double> b(static_cast<std::size_t>(unknowns), 1.0);
    std::vector<Solver> all = solvers(parts, b);
    measure(all, unknowns);
    const double reference = median(all.front().times);
    for (const Solver& solver : all) {
      const double time = median(solver.times);
      const double least = *std::min_element(solver.times.begin(), solver.times.end());
      std::printf("%10d  %-14s %14.2f %9.2f %9.2f\n", unknowns, solver.name.c_str(), time * 1e9 / unknowns,
                  time / reference, least * 1e9 / unknowns);
      table << unknowns << ',' << solver.name << ',' << time * 1e9 / unknowns << ',' << time / reference << '\n';
    }
    // Factors once from memory; x once to and fro in either sweep's stead, and its copy.
    const std::shared_ptr<solve::SubstructuredCholesky> cholesky = factored(parts);
    const double factor_bytes = 8.0 * static_cast<double>(cholesky->stored_numbers()) / unknowns;
    const double moved_bytes = factor_bytes + 2.0 * 8.0 + 2.0 * 8.0;
    std::vector<double> shared = b, whole = b;
    cholesky->solve(shared.data());
    factored(unequal(parts))->solve(whole.data());
    double largest = 0.0, off = 0.0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      largest = std::max(largest, std::abs(whole[i]));
      off = std::max(off, std::abs(shared[i] - whole[i]));
    }
    std::printf("%10d  %.1f B of factors an unknown; solutions differ from those kept whole by %.1e\n", unknowns,
                factor_bytes, off / largest);
    const double bandwidth = copy_bandwidth(static_cast<std::size_t>(unknowns * (factor_bytes + 16.0)));
    const double floor = moved_bytes / bandwidth * 1e9;
    std::printf("%10d  %-14s %14.2f %9.2f            (%.0f B an unknown at %.1f GB/s)\n", unknowns, "moving it", floor,
                floor * 1e-9 * unknowns / reference, moved_bytes, bandwidth * 1e-9);
    table << unknowns << ",moving it," << floor << ',' << floor * 1e-9 * unknowns / reference << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (PetscInitialize(&argc, &argv, nullptr, nullptr) != 0) return EXIT_FAILURE;
  try {
    run(argc > 1 ? argv[1] : nullptr, argc > 2 ? std::atoi(argv[2]) : sizes.back());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    (void)PetscFinalize();
    return EXIT_FAILURE;
  }
  (void)PetscFinalize();
  return EXIT_SUCCESS;
}
