// Splits the communicator; the ranks without work wait in a non-blocking barrier that they test between sleeps of
// growing length.
#include "run/active_ranks.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "run/process.hpp"
#include "run/signals.hpp"

namespace traverse::app {
namespace {

constexpr std::chrono::microseconds first_nap(100), longest_nap(10'000);

/// The ranks that work and those that wait come together.
int agree_on(MPI_Comm comm, int status) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(comm, &request);
  auto nap = first_nap;
  for (int together = 0;;) {
    MPI_Test(&request, &together, MPI_STATUS_IGNORE);
    if (together != 0) break;
    std::this_thread::sleep_for(nap);
    nap = std::min(2 * nap, longest_nap);
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
  MPI_Comm some = MPI_COMM_NULL;
  MPI_Comm_split(comm, rank < count ? 0 : MPI_UNDEFINED, rank, &some);
  if (some == MPI_COMM_NULL) {
    const SignalsNoted noted;  // those who work end in order
    return agree_on(comm, 0);
  }
  int status = 0;
  try {
    status = work(some);
  } catch (const std::exception& failure) {
    agree_on(comm, as_error(failure).status());
    MPI_Comm_free(&some);
    throw;
  }
  agree_on(comm, status);
  MPI_Comm_free(&some);
  return status;
}

}  // namespace traverse::app
