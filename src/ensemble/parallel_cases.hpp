// The runs of a sweep or a study, shared among the ranks: who takes what, how far all are, and what went wrong.
#pragma once

#include <mpi.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace traverse::app {

/// Runs that one rank takes together.
struct RunPiece {
  std::size_t runs = 0;
  double duration = 0.0;  // s of motion, of all of them
};

struct SharedWork {
  std::vector<RunPiece> pieces;  // in the order in which they are dealt
  /// Computes a piece; `reached` wants to hear the time of the motion that is stepped, s.
  std::function<void(std::size_t piece, const std::function<void(double)>& reached)> take;
  /// A piece in words, for the message of a failure.
  std::function<std::string(std::size_t piece)> name;
};

/// What went wrong, if anything.
struct RunFailure {
  static constexpr int nobody = std::numeric_limits<int>::max();
  int piece = nobody;  // in the order of dealing
  int status = 0;
  std::string message;

  bool failed() const { return piece != nobody; }
};

/// Collective. Each rank takes the next piece when it is free, until all are taken, one has failed or a signal has
/// come. Returns the failure of this rank.
RunFailure run_cases_in_parallel(MPI_Comm comm, const SharedWork& work, bool quiet);

/// Collective. The failure of the earliest piece, the same on every rank.
RunFailure first_of(MPI_Comm comm, RunFailure mine);

}  // namespace traverse::app
