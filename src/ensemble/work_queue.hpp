// Who computes what: pieces of work dealt among ranks, each to the next rank that is free.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <optional>

namespace traverse::app {

/// Ranks of one computer take from a common counter in shared memory, which costs nothing and waits for nobody; among
/// computers the pieces go round in turn.
class WorkQueue {
 public:
  /// Collective.
  WorkQueue(MPI_Comm comm, std::size_t pieces);
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;
  ~WorkQueue();

  /// The next piece for this rank, the first ones first.
  std::optional<std::size_t> next();
  /// Nothing more is dealt on this computer.
  void stop();
  /// How many pieces all ranks have taken, about.
  std::size_t taken() const;

 private:
  std::size_t pieces_;
  int computer_ = 0, computers_ = 1;
  MPI_Comm together_ = MPI_COMM_NULL;  // ranks of this computer
  MPI_Win window_ = MPI_WIN_NULL;
  long* taken_ = nullptr;  // in it: rounds taken on this computer
};

}  // namespace traverse::app
