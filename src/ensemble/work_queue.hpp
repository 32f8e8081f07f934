// Dynamic distribution of pieces of work: each rank gets the next piece when it is free.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <optional>

namespace traverse::ensemble {

/// Ranks of one computer use a common counter in shared memory, without communication or waiting; the computers get the
/// pieces in turn.
class WorkQueue {
 public:
  /// Collective.
  WorkQueue(MPI_Comm comm, std::size_t pieces);
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;
  ~WorkQueue();

  /// The next piece for this rank, in ascending order; empty: none remains.
  std::optional<std::size_t> next();
  /// Ends the distribution on this computer.
  void stop();
  /// The approximate number of pieces that all ranks have taken.
  std::size_t taken() const;

 private:
  std::size_t pieces_;
  int computer_ = 0, computers_ = 1;
  MPI_Comm local_comm_ = MPI_COMM_NULL;  // ranks of this computer
  MPI_Win window_ = MPI_WIN_NULL;
  long* taken_ = nullptr;  // in the window: rounds taken on this computer
};

}  // namespace traverse::ensemble
