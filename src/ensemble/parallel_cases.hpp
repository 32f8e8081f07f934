// Distributes the runs of a sweep or a study over the ranks, with progress and failures.
#pragma once

#include <mpi.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace traverse::ensemble {

/// Runs that one rank computes together.
struct RunPiece {
  std::size_t runs = 0;
  double duration = 0.0;  // simulated time of all its runs, s
};

struct SharedWork {
  std::vector<RunPiece> pieces;  // in the order of distribution
  /// Computes a piece; `reached` is called with the simulated time, s.
  std::function<void(std::size_t piece, const std::function<void(double)>& reached)> compute;
  /// The name of a piece in the message of a failure; empty: the message of the error alone.
  std::function<std::string(std::size_t piece)> name;
};

/// The failure of a piece, if any.
struct RunFailure {
  static constexpr int none = std::numeric_limits<int>::max();
  int piece = none;  // in the order of distribution
  int status = 0;
  std::string message;

  bool failed() const { return piece != none; }
};

/// Collective. Each rank computes the next piece when it is free, until no piece remains, one has failed or a signal
/// arrived. Returns the failure of this rank.
RunFailure run_cases_in_parallel(MPI_Comm comm, const SharedWork& work, bool quiet);

/// Collective. The failure of the earliest piece, the same on every rank.
RunFailure first_of(MPI_Comm comm, RunFailure mine);

}  // namespace traverse::ensemble
