// The beam's matrices as block tridiagonal slices, one block a node, and their exact factorisation over ranks.
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

  /// Reads this rank's rows of a PETSc matrix (AIJ) whose rows are node-wise blocks. Entries outside the block
  /// tridiagonal, other than zeros, are an error (std::logic_error). Rows without a diagonal entry are kept as zero.
  /// Blocks below the diagonal are not read: the matrix is taken to be symmetric.
  static BlockTridiagonal from(Mat matrix, int block_size);

  /// this = a*A + b*B + c*C, all four of one shape (else std::logic_error); no allocation. They may be the same.
  void combine(double a, const BlockTridiagonal& A, double b, const BlockTridiagonal& B, double c,
               const BlockTridiagonal& C);
};

/// Writes a right-hand side while it is being eliminated.
struct NodeFiller {
  /// Writes the right-hand side of this rank's nodes [first, past), which are about to be eliminated.
  virtual void fill(std::ptrdiff_t first, std::ptrdiff_t past) = 0;

 protected:
  ~NodeFiller() = default;
};

/// Exact factorisation A = block Cholesky (LDL^T) of a symmetric positive definite block tridiagonal matrix
/// cut over the ranks of `comm` by nodes: each rank eliminates its inner nodes, several chains at once, a small
/// block tridiagonal system couples the cuts, solved redundantly on every rank. No iteration, no tolerance.
class SubstructuredCholesky {
 public:
  /// Collective. local_nodes may be 0 on some ranks. Block sizes 2 to 7 are compiled for their size; others, up
  /// to 16, run a general path that takes about five times as long per entry.
  SubstructuredCholesky(MPI_Comm comm, int block_size, int local_nodes);
  ~SubstructuredCholesky();
  SubstructuredCholesky(SubstructuredCholesky&&) noexcept;
  SubstructuredCholesky& operator=(SubstructuredCholesky&&) noexcept;

  /// Collective. `fixed[i]` non-zero (one entry a local unknown; empty: none): row and column i are taken as the
  /// identity, so that solve returns the right-hand side there. Throws traverse::SolverError on every rank, naming the
  /// global unknown, when A is not positive definite.
  void factor(const BlockTridiagonal& A, const std::vector<char>& fixed);

  /// Collective. x: this rank's nodes*block entries of each column, column after column, in: right-hand sides,
  /// out: solutions. No allocation when columns <= the largest number used before.
  /// Uses buffers of this object: one solve at a time. Subnormal numbers (below 2.2e-308) count as zero meanwhile.
  void solve(double* x, int columns = 1) const;

  /// Collective. The same for one column whose right-hand side the filler writes into x, a few hundred nodes at a time,
  /// each of this rank's nodes once, in an order of the solver's, just before they are eliminated.
  void solve(double* x, NodeFiller& filler) const;

  /// Collective. As above where the right-hand side is zero outside this rank's nodes [first, past) (none where they
  /// are equal) and the solution is wanted inside only: the rest of x is neither read nor written. The solution is
  /// taken to vanish outside: what is wrong by that dies out from the window's ends as responses do, so the caller adds
  /// a margin.
  void solve_window(double* x, std::ptrdiff_t first, std::ptrdiff_t past, NodeFiller& filler) const;

  /// Collective. Several columns in a window, in a buffer of its nodes alone: node i, component c of a column at
  /// x[(i - first)*block + c + column*(past - first)*block].
  void solve_local(double* x, int columns, std::ptrdiff_t first, std::ptrdiff_t past) const;

  /// The smallest ratio, over all unknowns of all ranks, of a pivot to the diagonal entry it came from, of the last
  /// factor. A ratio r says that about log10(1/r) digits of the stiffness cancelled; near the rounding unit (1e-16)
  /// the solutions mean nothing. One for a diagonal matrix. The same on every rank.
  double pivot_ratio() const;

  /// Numbers of the last factor that this rank keeps. Where a few hundred nodes or more repeat to the last bit, as on
  /// equal spans, so do the factor's numbers after some ten periods, to rounding: one period of them is kept, as if the
  /// pivots were changed by a few times 1e-16 of themselves.
  std::size_t stored_numbers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse::solve
