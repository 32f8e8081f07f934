// Groups trains by common columns, gives the largest groups to the ranks with the least work, and exchanges messages of
// numbers.
#include "coupling/train_sharing.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "traverse/base/error.hpp"

namespace traverse::coupling {
namespace {

using structure::Range;

// Columns that move freely take as long as a vehicle in a stage, or as the evaluation of a vehicle, measured.
constexpr double columns_per_vehicle = 200.0, columns_per_evaluation = 70.0;
constexpr int tag = 0;

int length(const Range& range) { return range.past - range.first; }

/// Trains with common columns.
struct Group {
  std::vector<std::size_t> trains;
  std::vector<Range> columns;
  double work = 0.0;
};

bool overlap(const Range& a, const Range& b) { return a.first < b.past && b.first < a.past; }

std::vector<Group> groups_of(const std::vector<TrainReach>& trains) {
  std::vector<std::size_t> order(trains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t k) {  // trains beside the bridge come last
    return std::tuple(length(trains[k].columns) == 0, trains[k].columns.first, k);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<Group> groups;
  for (const std::size_t k : order) {
    const Range& columns = trains[k].columns;
    if (groups.empty() || groups.back().columns.empty() || !overlap(groups.back().columns.back(), columns))
      groups.emplace_back();
    Group& group = groups.back();
    group.trains.push_back(trains[k].train);
    if (length(columns) > 0) group.columns.push_back(columns);
    structure::merge(group.columns);
    group.work += columns_per_vehicle * trains[k].vehicles + length(columns);
  }
  return groups;
}

}  // namespace

std::vector<Portion> divide(const std::vector<TrainReach>& trains, const std::vector<Range>& moving, int ranks) {
  std::vector<Portion> portions(static_cast<std::size_t>(ranks));
  std::vector<double> work(portions.size(), 0.0);
  for (const TrainReach& train : trains) work.front() += columns_per_evaluation * train.vehicles;
  const auto give = [&](double more) {  // to the rank with the least work
    const auto rank = static_cast<std::size_t>(std::min_element(work.begin(), work.end()) - work.begin());
    work[rank] += more;
    return rank;
  };
  std::vector<Group> groups = groups_of(trains);
  std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.work > b.work; });
  std::vector<Range> reached, rest;
  for (const Group& group : groups) {
    Portion& portion = portions[give(group.work)];
    portion.trains.insert(portion.trains.end(), group.trains.begin(), group.trains.end());
    portion.columns.insert(portion.columns.end(), group.columns.begin(), group.columns.end());
    reached.insert(reached.end(), group.columns.begin(), group.columns.end());
  }
  structure::merge(reached);
  structure::subtract(moving, reached, rest);
  for (const Range& free : rest) portions[give(length(free))].columns.push_back(free);
  for (Portion& portion : portions) {
    std::sort(portion.trains.begin(), portion.trains.end());
    structure::merge(portion.columns);
  }
  return portions;
}

TrainSharing::TrainSharing(MPI_Comm comm) : comm_(comm) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &ranks_);
  observed.resize(static_cast<std::size_t>(ranks_));
  sums.resize(static_cast<std::size_t>(ranks_));
}

TrainSharing::~TrainSharing() {
  if (leads() && !ended_) request(end);
}

void TrainSharing::request(Request what, double t, double h) {
  Command command{static_cast<double>(what), t, h};
  MPI_Bcast(&command, 3, MPI_DOUBLE, 0, comm_);
  ended_ = what == end;
}

TrainSharing::Command TrainSharing::next() {
  Command command;
  MPI_Bcast(&command, 3, MPI_DOUBLE, 0, comm_);
  return command;
}

void TrainSharing::put(const std::vector<Range>& ranges) {
  put(static_cast<double>(ranges.size()));
  for (const Range& r : ranges) {
    put(r.first);
    put(r.past);
  }
}

void TrainSharing::get(double* numbers, std::size_t count) {
  if (read_ + count > message_.size()) throw SolverError("a message between ranks is too short");
  std::copy_n(message_.begin() + static_cast<std::ptrdiff_t>(read_), count, numbers);
  read_ += count;
}

double TrainSharing::get() {
  double number = 0.0;
  get(&number, 1);
  return number;
}

void TrainSharing::get(std::vector<Range>& ranges) {
  ranges.resize(static_cast<std::size_t>(get()));
  for (Range& r : ranges) {
    r.first = static_cast<int>(get());
    r.past = static_cast<int>(get());
  }
}

void TrainSharing::send(int rank) {
  MPI_Send(message_.data(), static_cast<int>(message_.size()), MPI_DOUBLE, rank, tag, comm_);
}

void TrainSharing::receive(int rank) {
  MPI_Status status;
  MPI_Probe(rank, tag, comm_, &status);
  int count = 0;
  MPI_Get_count(&status, MPI_DOUBLE, &count);
  message_.resize(static_cast<std::size_t>(count));
  MPI_Recv(message_.data(), count, MPI_DOUBLE, rank, tag, comm_, MPI_STATUS_IGNORE);
  read_ = 0;
}

}  // namespace traverse::coupling
