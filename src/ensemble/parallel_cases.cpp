// Executes dealt pieces until none is left, an error occurs or a signal arrives, and estimates progress from the
// durations of the runs.
#include "ensemble/parallel_cases.hpp"

#include <algorithm>

#include "ensemble/work_queue.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/process.hpp"
#include "run/signals.hpp"

namespace traverse::app {
namespace {

/// How far all are, by the time that the runs' motions last: the longest ones are dealt first.
class Course {
 public:
  Course(const std::vector<RunPiece>& pieces, int ranks, bool quiet)
      : ranks_(static_cast<std::size_t>(ranks)), progress_(0.0, 1.0, quiet) {
    for (const RunPiece& piece : pieces) {
      duration_.push_back(piece.duration);
      until_.push_back(until_.back() + piece.duration);
      runs_.push_back(runs_.back() + piece.runs);
    }
  }

  /// So many pieces are taken; this rank's own has `left` s to go, those of the others half of theirs.
  void show(std::size_t taken, double left) {
    if (taken == 0) return;
    const double others = 0.5 * static_cast<double>(ranks_ - 1) * duration_[taken - 1];
    const double done = std::max(until_[taken] - left - others, 0.0);
    progress_.runs(done / until_.back(), runs_[taken > ranks_ ? taken - ranks_ : 0], runs_.back());
  }
  void done() { progress_.done(); }

 private:
  std::size_t ranks_;
  results::Progress progress_;
  std::vector<double> duration_, until_{0.0};  // s, of the runs of each piece, and of all pieces before it
  std::vector<std::size_t> runs_{0};           // in the pieces before each
};

}  // namespace

RunFailure run_cases_in_parallel(MPI_Comm comm, const SharedWork& work, bool quiet) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  Course course(work.pieces, ranks, quiet || rank != 0);
  WorkQueue deal(comm, work.pieces.size());
  RunFailure failure;
  while (const auto piece = deal.next()) {
    const auto fail = [&](const Error& error) {
      failure = {static_cast<int>(*piece), error.status(), work.name(*piece) + " failed: " + error.what()};
      deal.stop();
    };
    const double duration = work.pieces[*piece].duration;
    try {
      work.take(*piece, [&](double t) { course.show(deal.taken(), std::max(duration - t, 0.0)); });
    } catch (const Error& error) {
      fail(error);
    } catch (const std::exception& failed) {
      fail(as_error(failed));
    }
    if (caught_signal() != 0) deal.stop();
    course.show(deal.taken(), 0.0);
    results::Stage::advance(static_cast<double>(deal.taken()) / static_cast<double>(work.pieces.size()));
  }
  course.done();
  return failure;
}

RunFailure first_of(MPI_Comm comm, RunFailure mine) {
  int ranks = 1, rank = 0;
  MPI_Comm_size(comm, &ranks);
  MPI_Comm_rank(comm, &rank);
  int place[2] = {mine.piece, rank};
  MPI_Allreduce(MPI_IN_PLACE, place, 1, MPI_2INT, MPI_MINLOC, comm);
  if (place[0] == RunFailure::nobody) return {};
  int sizes[2] = {static_cast<int>(mine.message.size()), mine.status};
  MPI_Bcast(sizes, 2, MPI_INT, place[1], comm);
  mine.message.resize(static_cast<std::size_t>(sizes[0]));
  MPI_Bcast(mine.message.data(), sizes[0], MPI_CHAR, place[1], comm);
  return {place[0], sizes[1], mine.message};
}

}  // namespace traverse::app
