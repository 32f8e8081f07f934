// Evaluates the model of a fit at several points at once, distributed over the ranks. Rank 0 asks, the others compute.
#pragma once

#include <mpi.h>

#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace traverse::fit {

class Evaluator {
 public:
  using Values = std::vector<double>;
  /// compute: `size` results at each of at most `width` points of `dimension` values, the same on every rank and in any
  /// company.
  using Compute = std::function<std::vector<Values>(const std::vector<Values>& points)>;
  Evaluator(MPI_Comm comm, std::size_t dimension, std::size_t size, std::size_t width, Compute compute);

  /// On rank 0, while the others serve: the results at all points, which the ranks compute in turn. The results at the
  /// last points are stored and not computed again. Throws the Error of the first point that fails, and
  /// Interrupted if a rank has caught a signal.
  std::vector<Values> evaluate(const std::vector<Values>& points);
  struct Interrupted {
    int signal = 0;
  };
  /// Computed points so far.
  long evaluations() const { return evaluations_; }

  /// On the other ranks: computes until rank 0 calls stop.
  void serve();
  /// On rank 0: ends serve() on the others.
  void stop();

 private:
  const Values* stored(const Values& point) const;
  void compute(const std::vector<Values>& open, Values& flat);
  void compute_in_turn(const Values& points, std::vector<Values>& results);

  MPI_Comm comm_;
  int rank_ = 0, ranks_ = 1;
  std::size_t dimension_, size_, width_;
  Compute compute_;
  std::deque<std::pair<Values, Values>> stored_;
  long evaluations_ = 0;
};

}  // namespace traverse::fit
