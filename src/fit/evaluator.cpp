// A number of points is broadcast, then the points; each rank computes the next group of points when it is free, and
// the results are added, with zeros from all other ranks, so that they do not depend on the number of ranks.
#include "fit/evaluator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ensemble/parallel_cases.hpp"
#include "run/process.hpp"
#include "traverse/base/error.hpp"

namespace traverse::fit {
namespace {
constexpr std::size_t most_stored = 32;
}

Evaluator::Evaluator(MPI_Comm comm, std::size_t dimension, std::size_t size, std::size_t width, Compute compute)
    : comm_(comm), dimension_(dimension), size_(size), width_(width), compute_(std::move(compute)) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &ranks_);
}

void Evaluator::compute_in_turn(const Values& points, std::vector<Values>& results) {
  const std::size_t count = points.size() / dimension_, ranks = static_cast<std::size_t>(ranks_);
  const std::size_t group = std::min(width_, (count + ranks - 1) / ranks);
  results.assign(count, Values());
  ensemble::SharedWork work;
  for (std::size_t first = 0; first < count; first += group)
    work.pieces.push_back({std::min(group, count - first), 1.0});
  work.compute = [&](std::size_t piece, const std::function<void(double)>& /*reached*/) {
    std::vector<Values> own;
    for (std::size_t k = piece * group; k < std::min((piece + 1) * group, count); ++k) {
      const auto from = points.begin() + static_cast<std::ptrdiff_t>(k * dimension_);
      own.emplace_back(from, from + static_cast<std::ptrdiff_t>(dimension_));
    }
    std::ranges::move(compute_(own), results.begin() + static_cast<std::ptrdiff_t>(piece * group));
  };
  ensemble::RunFailure failure = ensemble::run_cases_in_parallel(comm_, work, true);
  const int signal = run::signal_on_any(comm_);
  failure = ensemble::first_of(comm_, std::move(failure));
  if (signal != 0) throw Interrupted{signal};
  if (failure.failed()) throw Error(failure.message, failure.status);
  for (Values& result : results) {
    result.resize(size_, 0.0);
    const void* own = rank_ == 0 ? MPI_IN_PLACE : static_cast<const void*>(result.data());
    MPI_Reduce(own, result.data(), static_cast<int>(size_), MPI_DOUBLE, MPI_SUM, 0, comm_);
  }
}

std::vector<Evaluator::Values> Evaluator::evaluate(const std::vector<Values>& points) {
  std::vector<Values> open;
  Values flat;
  for (const Values& point : points) {
    if (stored(point) != nullptr || std::find(open.begin(), open.end(), point) != open.end()) continue;
    open.push_back(point);
    flat.insert(flat.end(), point.begin(), point.end());
  }
  if (!open.empty()) compute(open, flat);
  std::vector<Values> results;
  for (const Values& point : points) results.push_back(*stored(point));
  while (stored_.size() > most_stored) stored_.pop_front();
  return results;
}

const Evaluator::Values* Evaluator::stored(const Values& point) const {
  const auto known = std::find_if(stored_.begin(), stored_.end(), [&](const auto& one) { return one.first == point; });
  return known == stored_.end() ? nullptr : &known->second;
}

void Evaluator::compute(const std::vector<Values>& open, Values& flat) {
  int count = static_cast<int>(open.size());
  MPI_Bcast(&count, 1, MPI_INT, 0, comm_);
  MPI_Bcast(flat.data(), static_cast<int>(flat.size()), MPI_DOUBLE, 0, comm_);
  std::vector<Values> computed;
  compute_in_turn(flat, computed);
  evaluations_ += count;
  for (std::size_t i = 0; i < open.size(); ++i) stored_.emplace_back(open[i], std::move(computed[i]));
}

void Evaluator::serve() {
  while (true) {
    int count = 0;
    MPI_Bcast(&count, 1, MPI_INT, 0, comm_);
    if (count == 0) return;
    Values points(static_cast<std::size_t>(count) * dimension_);
    MPI_Bcast(points.data(), static_cast<int>(points.size()), MPI_DOUBLE, 0, comm_);
    std::vector<Values> results;
    try {
      compute_in_turn(points, results);
    } catch (const Error&) {        // rank 0 has the same error and decides
    } catch (const Interrupted&) {  // likewise
    }
  }
}

void Evaluator::stop() {
  int none = 0;
  MPI_Bcast(&none, 1, MPI_INT, 0, comm_);
}

}  // namespace traverse::fit
