// Rows of numbers that ranks send to the first one as they come, while all go on computing.
#pragma once

#include <mpi.h>

#include <deque>
#include <functional>
#include <vector>

namespace traverse::app {

class ResultGather {
 public:
  /// Collective. `store` takes a row on rank 0.
  ResultGather(MPI_Comm comm, std::function<void(const std::vector<double>& row)> store);
  ~ResultGather();
  ResultGather(const ResultGather&) = delete;
  ResultGather& operator=(const ResultGather&) = delete;

  /// Hands a row in. It does not wait for rank 0.
  void send(std::vector<double> row);
  /// On rank 0: stores the rows that have come. Elsewhere: lets go of those that have left.
  void collect();
  /// Collective. Until all rows of all ranks are stored; nothing may be sent afterwards.
  void finish();

 private:
  struct Sent {
    std::vector<double> row;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  void take(const MPI_Status& coming);

  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, ranks_ = 1, ended_ = 1;  // ranks that have sent all
  std::function<void(const std::vector<double>&)> store_;
  std::deque<Sent> sent_;  // their addresses stay
};

}  // namespace traverse::app
