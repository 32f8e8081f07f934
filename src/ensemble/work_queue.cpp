// Distributes pieces of work by an atomic counter in the MPI shared memory of each computer; the computers get the
// pieces in turn.
#include "ensemble/work_queue.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

namespace traverse::ensemble {
namespace {
constexpr long stop_value = std::numeric_limits<long>::max() / 2;
}

WorkQueue::WorkQueue(MPI_Comm comm, std::size_t pieces) : pieces_(pieces) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &local_comm_);
  int local_rank = 0;
  MPI_Comm_rank(local_comm_, &local_rank);
  // The first rank of each computer counts the computers.
  MPI_Comm firsts = MPI_COMM_NULL;
  MPI_Comm_split(comm, local_rank == 0 ? 0 : MPI_UNDEFINED, rank, &firsts);
  if (firsts != MPI_COMM_NULL) {
    MPI_Comm_rank(firsts, &computer_);
    MPI_Comm_size(firsts, &computers_);
    MPI_Comm_free(&firsts);
  }
  int place[2] = {computer_, computers_};
  MPI_Bcast(place, 2, MPI_INT, 0, local_comm_);
  computer_ = place[0];
  computers_ = place[1];
  const MPI_Aint size = local_rank == 0 ? sizeof(long) : 0;
  MPI_Win_allocate_shared(size, sizeof(long), MPI_INFO_NULL, local_comm_, &taken_, &window_);
  MPI_Aint ignored = 0;
  int unit = 0;
  MPI_Win_shared_query(window_, 0, &ignored, &unit, &taken_);
  if (local_rank == 0) *taken_ = 0;
  MPI_Win_fence(0, window_);
}

WorkQueue::~WorkQueue() {
  MPI_Win_free(&window_);
  MPI_Comm_free(&local_comm_);
}

std::optional<std::size_t> WorkQueue::next() {
  const long round = std::atomic_ref<long>(*taken_).fetch_add(1);
  if (round >= stop_value) return std::nullopt;
  const std::size_t piece =
      static_cast<std::size_t>(round) * static_cast<std::size_t>(computers_) + static_cast<std::size_t>(computer_);
  if (piece >= pieces_) return std::nullopt;
  return piece;
}

void WorkQueue::stop() { std::atomic_ref<long>(*taken_).store(stop_value); }

std::size_t WorkQueue::taken() const {
  const auto rounds = static_cast<std::size_t>(std::atomic_ref<long>(*taken_).load());
  return std::min(rounds * static_cast<std::size_t>(computers_), pieces_);
}

}  // namespace traverse::ensemble
