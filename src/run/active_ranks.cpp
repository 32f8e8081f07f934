// Splits the communicator. The ranks without work wait in a non-blocking barrier, which they test at increasing
// intervals.
#include "run/active_ranks.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "run/process.hpp"
#include "run/signals.hpp"

namespace traverse::run {
namespace {

constexpr std::chrono::microseconds first_interval(100), longest_interval(10'000);

/// Waits until the working and the waiting ranks have reached this point, and broadcasts the status.
int synchronise(MPI_Comm comm, int status) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(comm, &request);
  auto interval = first_interval;
  for (int complete = 0;;) {
    MPI_Test(&request, &complete, MPI_STATUS_IGNORE);
    if (complete != 0) break;
    std::this_thread::sleep_for(interval);
    interval = std::min(2 * interval, longest_interval);
  }
  MPI_Bcast(&status, 1, MPI_INT, 0, comm);
  return status;
}

}  // namespace

int run_on_first(MPI_Comm comm, int count, const std::function<int(MPI_Comm)>& work) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  if (count >= ranks) return work(comm);
  MPI_Comm active = MPI_COMM_NULL;
  MPI_Comm_split(comm, rank < count ? 0 : MPI_UNDEFINED, rank, &active);
  if (active == MPI_COMM_NULL) {
    const DeferredSignals handlers;  // the working ranks end the run in order
    return synchronise(comm, 0);
  }
  int status = 0;
  try {
    status = work(active);
  } catch (const std::exception& failure) {
    synchronise(comm, as_error(failure).status());
    MPI_Comm_free(&active);
    throw;
  }
  synchronise(comm, status);
  MPI_Comm_free(&active);
  return status;
}

}  // namespace traverse::run
