// Computes pieces of work until none remains, an error occurs or a signal arrives, and estimates progress from the
// durations of the runs.
#include "ensemble/parallel_cases.hpp"

#include <algorithm>

#include "base/broadcast.hpp"
#include "ensemble/work_queue.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/process.hpp"

namespace traverse::ensemble {
namespace {

/// Progress of all ranks by the simulated time of the runs; the longest pieces are distributed first.
class ProgressEstimate {
 public:
  ProgressEstimate(const std::vector<RunPiece>& pieces, int ranks, bool quiet)
      : ranks_(static_cast<std::size_t>(ranks)), progress_(0.0, 1.0, quiet) {
    for (const RunPiece& piece : pieces) {
      duration_.push_back(piece.duration);
      duration_before_.push_back(duration_before_.back() + piece.duration);
      runs_before_.push_back(runs_before_.back() + piece.runs);
    }
  }

  /// `taken` pieces were distributed. The remaining simulated time of this rank's piece is `remaining`, s; for the
  /// pieces of other ranks it is assumed to be half of their duration.
  void show(std::size_t taken, double remaining) {
    if (taken == 0) return;
    const double others = 0.5 * static_cast<double>(ranks_ - 1) * duration_[taken - 1];
    const double done = std::max(duration_before_[taken] - remaining - others, 0.0);
    progress_.runs(done / duration_before_.back(), runs_before_[taken > ranks_ ? taken - ranks_ : 0],
                   runs_before_.back());
  }
  void done() { progress_.done(); }

 private:
  std::size_t ranks_;
  results::Progress progress_;
  std::vector<double> duration_, duration_before_{0.0};  // s, of the runs of each piece, and of all pieces before it
  std::vector<std::size_t> runs_before_{0};              // in the pieces before each
};

}  // namespace

RunFailure run_cases_in_parallel(MPI_Comm comm, const SharedWork& work, bool quiet) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  ProgressEstimate progress(work.pieces, ranks, quiet || rank != 0);
  WorkQueue queue(comm, work.pieces.size());
  RunFailure failure;
  while (const auto piece = queue.next()) {
    const auto fail = [&](const Error& error) {
      failure = {static_cast<int>(*piece), error.status(),
                 work.name ? work.name(*piece) + " failed: " + error.what() : error.what()};
      queue.stop();
    };
    const double duration = work.pieces[*piece].duration;
    try {
      work.compute(*piece, [&](double t) { progress.show(queue.taken(), std::max(duration - t, 0.0)); });
    } catch (const Error& error) {
      fail(error);
    } catch (const std::exception& failed) {
      fail(run::as_error(failed));
    }
    if (run::caught_signal() != 0) queue.stop();
    progress.show(queue.taken(), 0.0);
    results::Stage::advance(static_cast<double>(queue.taken()) / static_cast<double>(work.pieces.size()));
  }
  progress.done();
  return failure;
}

RunFailure first_of(MPI_Comm comm, RunFailure mine) {
  int ranks = 1, rank = 0;
  MPI_Comm_size(comm, &ranks);
  MPI_Comm_rank(comm, &rank);
  int earliest[2] = {mine.piece, rank};
  MPI_Allreduce(MPI_IN_PLACE, earliest, 1, MPI_2INT, MPI_MINLOC, comm);
  if (earliest[0] == RunFailure::none) return {};
  MPI_Bcast(&mine.status, 1, MPI_INT, earliest[1], comm);
  return {earliest[0], mine.status, base::broadcast(comm, std::move(mine.message), earliest[1])};
}

}  // namespace traverse::ensemble
