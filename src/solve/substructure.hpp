// The exact solution over ranks: the LocalFactor of every rank, and the small system of the separators between them.
#pragma once

#include <mpi.h>

#include <memory>
#include <optional>
#include <vector>

#include "local_factor.hpp"
#include "solve/block_tridiagonal.hpp"

namespace traverse::solve {

/// The distribution of the nodes over the ranks. Ranks without nodes only exchange messages.
struct Partition {
  Partition(MPI_Comm communicator, int local_nodes);

  /// One separator for each rank with nodes except the first one.
  int separators() const { return std::max(0, static_cast<int>(active.size()) - 1); }
  bool follows() const { return own_index > 0; }
  bool followed() const { return own_index >= 0 && own_index + 1 < static_cast<int>(active.size()); }
  int ranks() const { return static_cast<int>(begins.size()); }

  MPI_Comm comm;
  int rank = 0;
  int nodes = 0;
  std::vector<std::ptrdiff_t> begins;  // each rank's first global node
  std::vector<int> active;             // the ranks with nodes
  int own_index = -1;                  // this rank's index in `active`; -1: no nodes
};

/// The arguments of a solve.
struct Request {
  Columns x;
  int columns;
  Range window;               // this rank's nodes
  RhsCallback* rhs_callback;  // null: x contains the right-hand side
};

/// SubstructuredCholesky for one block size.
class AnySubstructure {
 public:
  virtual ~AnySubstructure() = default;
  virtual void factor(const BlockTridiagonal& A, const std::vector<char>& fixed) = 0;
  virtual void solve(const Request& request) = 0;
  virtual double pivot_ratio() const = 0;
  virtual std::size_t stored_numbers() const = 0;
};

template <int B>
class Substructure final : public AnySubstructure {
 public:
  Substructure(MPI_Comm comm, int block_size, int local_nodes);
  void factor(const BlockTridiagonal& A, const std::vector<char>& fixed) override;
  void solve(const Request& request) override;
  double pivot_ratio() const override { return record_.smallest_ratio; }
  std::size_t stored_numbers() const override { return local_ ? local_->stored_numbers() : 0; }

 private:
  std::uint64_t next_fixed(const std::vector<char>& fixed) const;
  void pack_factor(const Slice<B>& slice);
  void gather_factors();
  const double* factor_message(int place) const;
  void factor_separators();
  void agree_on_failure() const;
  [[noreturn]] void fail(std::ptrdiff_t unknown, double pivot, double diagonal) const;

  void solve_separators(int columns);
  template <int C>
  void reduce(const Request& request, int column);
  template <int C>
  void expand(const Request& request, int column);
  template <int C>
  void solve_single(const Request& request, int column);

  Extent<B> block_;
  Partition partition_;
  std::optional<LocalFactor<B>> local_;
  std::optional<LocalFactor<B>> separators_;
  PivotRecord record_;
  bool factored_ = false;

  BlockTridiagonal reduced_matrix_;       // matrix of the separators, in the order of the ranks
  std::vector<double> reduced_diagonal_;  // their diagonal entries in the original matrix
  std::vector<double> outgoing_;          // messages: this rank's and all ranks'
  std::vector<double> incoming_;
  std::vector<double> reduced_;  // the separators' unknowns, column after column
};

}  // namespace traverse::solve
