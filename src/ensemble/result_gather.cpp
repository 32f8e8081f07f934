// Sends rows of results by non-blocking MPI messages, which the first rank receives between its own runs.
#include "ensemble/result_gather.hpp"

#include <utility>

namespace traverse::ensemble {
namespace {
constexpr int tag_row = 1, tag_end = 2;
}

ResultGather::ResultGather(MPI_Comm comm, std::function<void(const std::vector<double>&)> store)
    : store_(std::move(store)) {
  MPI_Comm_dup(comm, &comm_);
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &ranks_);
}

ResultGather::~ResultGather() { MPI_Comm_free(&comm_); }

void ResultGather::send(std::vector<double> row) {
  if (rank_ == 0) return store_(row);
  Sent& sent = sent_.emplace_back();
  sent.row = std::move(row);
  MPI_Isend(sent.row.data(), static_cast<int>(sent.row.size()), MPI_DOUBLE, 0, tag_row, comm_, &sent.request);
}

void ResultGather::receive(const MPI_Status& status) {
  int size = 0;
  MPI_Get_count(&status, MPI_DOUBLE, &size);
  std::vector<double> row(static_cast<std::size_t>(size));
  MPI_Recv(row.data(), size, MPI_DOUBLE, status.MPI_SOURCE, status.MPI_TAG, comm_, MPI_STATUS_IGNORE);
  if (status.MPI_TAG == tag_end)
    ++ended_;
  else
    store_(row);
}

void ResultGather::collect() {
  if (rank_ != 0) {
    int done = 1;
    while (!sent_.empty() && done != 0) {
      MPI_Test(&sent_.front().request, &done, MPI_STATUS_IGNORE);
      if (done != 0) sent_.pop_front();
    }
    return;
  }
  for (int pending = 1; pending != 0;) {
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_, &pending, &status);
    if (pending != 0) receive(status);
  }
}

void ResultGather::finish() {
  if (rank_ != 0) {
    MPI_Send(nullptr, 0, MPI_DOUBLE, 0, tag_end, comm_);
    for (Sent& sent : sent_) MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
    sent_.clear();
    return;
  }
  while (ended_ < ranks_) {
    MPI_Status status;
    MPI_Probe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_, &status);
    receive(status);
  }
}

}  // namespace traverse::ensemble
