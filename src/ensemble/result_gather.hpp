// Rows of numbers that ranks send to the first rank without waiting, while all ranks continue their computations.
#pragma once

#include <mpi.h>

#include <deque>
#include <functional>
#include <vector>

namespace traverse::ensemble {

class ResultGather {
 public:
  /// Collective. `store` is called with each row on rank 0.
  ResultGather(MPI_Comm comm, std::function<void(const std::vector<double>& row)> store);
  ~ResultGather();
  ResultGather(const ResultGather&) = delete;
  ResultGather& operator=(const ResultGather&) = delete;

  /// Sends a row without waiting for rank 0.
  void send(std::vector<double> row);
  /// On rank 0: stores the rows that have arrived. On other ranks: frees the rows that were sent.
  void collect();
  /// Collective. Waits until all rows of all ranks are stored; nothing may be sent afterwards.
  void finish();

 private:
  struct Sent {
    std::vector<double> row;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  void receive(const MPI_Status& status);

  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, ranks_ = 1, ended_ = 1;  // ended_: ranks that have sent all their rows
  std::function<void(const std::vector<double>&)> store_;
  std::deque<Sent> sent_;  // a deque, because the addresses must remain valid
};

}  // namespace traverse::ensemble
