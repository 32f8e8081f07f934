// The beam's matrices as block tridiagonal slices, one block per node, and their exact factorisation over ranks.
#pragma once

#include <mpi.h>
#include <petscmat.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace traverse::solve {

/// One rank's slice of a symmetric block tridiagonal matrix: contiguous nodes, `block` unknowns each.
/// diagonal: nodes blocks of block x block, column-major. upper: as many; block i couples node i (rows) to
/// node i + 1 (columns); the last one couples to the next rank's first node (zero at the right end).
struct BlockTridiagonal {
  int block = 0;
  int nodes = 0;
  std::vector<double> diagonal;
  std::vector<double> upper;

  BlockTridiagonal() = default;
  BlockTridiagonal(int block_size, int local_nodes);

  /// Reads this rank's rows of a PETSc matrix (AIJ) whose rows are node-wise blocks. Non-zero entries outside the block
  /// tridiagonal are an error (std::logic_error). Rows without a diagonal entry remain zero. Blocks below the diagonal
  /// are not read, because the matrix must be symmetric.
  static BlockTridiagonal from(Mat matrix, int block_size);

  /// this = a*A + b*B + c*C. All four must have the same shape (otherwise std::logic_error) and may be the same object.
  /// No allocation.
  void combine(double a, const BlockTridiagonal& A, double b, const BlockTridiagonal& B, double c,
               const BlockTridiagonal& C);
};

/// A callback that writes a right-hand side during the elimination.
struct RhsCallback {
  /// Writes the right-hand side of this rank's nodes [first, past), which are eliminated next.
  virtual void fill(std::ptrdiff_t first, std::ptrdiff_t past) = 0;

 protected:
  ~RhsCallback() = default;
};

/// Exact factorisation A = block Cholesky (LDL^T) of a symmetric positive definite block tridiagonal matrix that is
/// distributed over the ranks of `comm` by nodes. Each rank eliminates its inner nodes, several chains at once; a small
/// block tridiagonal system couples the ranks, and every rank solves it. No iteration, no tolerance.
class SubstructuredCholesky {
 public:
  /// Collective. local_nodes may be 0 on some ranks. Block sizes 2 to 7 are compiled for their size; others, up to 16,
  /// use general code that takes about five times as long per entry.
  SubstructuredCholesky(MPI_Comm comm, int block_size, int local_nodes);
  ~SubstructuredCholesky();
  SubstructuredCholesky(SubstructuredCholesky&&) noexcept;
  SubstructuredCholesky& operator=(SubstructuredCholesky&&) noexcept;

  /// Collective. `fixed[i]` non-zero (one entry per local unknown; empty: none): row and column i are replaced by the
  /// identity, so that solve returns the right-hand side there. Throws traverse::SolverError on every rank, naming the
  /// global unknown, if A is not positive definite.
  void factor(const BlockTridiagonal& A, const std::vector<char>& fixed);

  /// Collective. x: this rank's nodes*block entries of each column, column after column, in: right-hand sides, out:
  /// solutions. No allocation if columns <= the largest number used before. Uses buffers of this object: one solve at a
  /// time. Subnormal numbers (below 2.2e-308) are set to zero during the solve.
  void solve(double* x, int columns = 1) const;

  /// Collective. Solves for one column. The callback writes the right-hand side into x, a few hundred nodes at a time,
  /// just before they are eliminated; each of this rank's nodes once, in an order chosen by the solver.
  void solve(double* x, RhsCallback& rhs_callback) const;

  /// Collective. Solves with the callback within a window, this rank's nodes [first, past) (empty if both are equal).
  /// The right-hand side is zero outside the window; values of x outside it are not read and not written. The solution
  /// is assumed to be zero outside. The resulting error decays from the window's ends as responses do, so that the
  /// caller must add a margin.
  void solve_window(double* x, std::ptrdiff_t first, std::ptrdiff_t past, RhsCallback& rhs_callback) const;

  /// Collective. Solves for several columns in a window. x has the window's nodes only: component c of node i is at
  /// x[(i - first)*block + c + column*(past - first)*block].
  void solve_local(double* x, int columns, std::ptrdiff_t first, std::ptrdiff_t past) const;

  /// The smallest ratio of a pivot to its diagonal entry in the matrix, over all unknowns of all ranks, of the last
  /// factor. A ratio r means that about log10(1/r) digits of the stiffness cancelled; near the rounding unit (1e-16)
  /// the solutions are not meaningful. One for a diagonal matrix. The same on every rank.
  double pivot_ratio() const;

  /// Number of values of the last factor that this rank stores. If a few hundred nodes or more repeat to the last bit,
  /// as on equal spans, the factor's values repeat after some ten periods, to rounding. Then only one period is stored,
  /// which is equivalent to relative changes of the pivots of a few times 1e-16.
  std::size_t stored_numbers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse::solve
