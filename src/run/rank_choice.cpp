// Measures the latency of MPI_Allreduce, estimates the duration of a stage on every number of ranks from unknowns,
// vehicles and messages, and selects the number above which more ranks gain too little. The ranks without work wait in
// a non-blocking barrier, which they test at increasing intervals.
#include "run/rank_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "run/process.hpp"
#include "run/step_cost.hpp"

namespace traverse::run {
namespace {

// Time for a coach in a stage, s: the part that only its rank computes, and its contacts, which every rank solves
// together with all others.
constexpr double vehicle_seconds = 3.0e-6, contact_seconds = 1.7e-6;
constexpr double messages = 9.0;            // number of messages in a stage, as counted on two ranks (doc/scaling.md)
constexpr double delay = 0.5e-6;            // s, mean delay of ranks at a message
constexpr double required_ratio = 0.85;     // more ranks must need less than this share of the time
constexpr int max_ranks_considered = 1024;  // ranks
constexpr int batches = 7, batch = 100;     // numbers of messages, to measure their latency
constexpr double pause = 2e-5;              // s, of computation between two of these messages

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

StageWork stage_work(const scene::Scene& scene) {
  StageWork work;
  if (!scene.beam) {
    work.vehicles = static_cast<double>(scene.train.vehicles.size());
    return work;
  }
  const beam::BeamModel& beam = *scene.beam;
  const bool spans_apart = beam.all_separate() && beam.spans.size() > 1;
  work.unknowns = unknowns_of(scene);
  work.seconds_per_unknown = unknown_seconds(scene);
  // Every rank computes all linear vehicles.
  work.vehicles =
      scene.model.vehicles == scene::VehicleModel::linear ? 0.0 : static_cast<double>(scene.train.vehicles.size());
  work.cut = !(scene.model.window_tolerance > 0.0 || (scene.model.window_tolerance < 0.0 && spans_apart));
  if (scene.model.modes > 0)
    work.single_rank_reason = "the modes' steps have no more in them than a message";
  else if (work.vehicles == 0.0 && !work.cut)
    work.single_rank_reason = "the spans near linear vehicles have no more in them than a message";
  return work;
}

double stage_seconds(const StageWork& work, int ranks, double latency) {
  const double share = static_cast<double>(ranks);
  const double structure = work.unknowns * work.seconds_per_unknown / (work.cut ? share : 1.0);
  const double vehicles = vehicle_seconds * std::ceil(work.vehicles / share) + contact_seconds * work.vehicles;
  return structure + vehicles + messages * (latency + delay) * std::ceil(std::log2(share));
}

int best_ranks(const StageWork& work, int most, double latency) {
  int best = 1;
  if (!work.single_rank_reason.empty()) return best;
  double least = stage_seconds(work, 1, latency);
  for (int ranks = 2; ranks <= most; ++ranks) {
    const double seconds = stage_seconds(work, ranks, latency);
    if (seconds > required_ratio * least) continue;
    least = seconds;
    best = ranks;
  }
  return best;
}

double message_latency(MPI_Comm comm) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  if (ranks == 1) return 0.0;
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  std::array<double, 8> numbers{};
  std::array<double, batches> durations{};
  for (double& seconds : durations) {
    MPI_Barrier(comm);
    const auto begin = Clock::now();
    for (int k = 0; k < batch; ++k) {
      const auto busy = Clock::now();
      while (since(busy) < pause) {
      }
      MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, MPI_SUM, comm);
    }
    seconds = std::max(0.0, since(begin) / batch - pause);
  }
  std::nth_element(durations.begin(), durations.begin() + batches / 2, durations.end());
  double latency = durations[batches / 2] / std::ceil(std::log2(static_cast<double>(ranks)));
  MPI_Bcast(&latency, 1, MPI_DOUBLE, 0, comm);
  return latency;
}

RankChoice choose_ranks(MPI_Comm comm, const scene::Scene& scene) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  if (ranks == 1) return {};
  const StageWork work = stage_work(scene);
  if (scene.all_ranks) return {ranks, fmt::format("ranks: all {} share the time steps (-step_ranks all)", ranks)};
  if (!work.single_rank_reason.empty())
    return {1, fmt::format("ranks: 1 of {} takes all steps, the others wait: {}", ranks, work.single_rank_reason)};
  const double latency = message_latency(comm);
  const int chosen = best_ranks(work, ranks, latency), best = best_ranks(work, max_ranks_considered, latency);
  const auto gain = [&](int count) { return stage_seconds(work, 1, latency) / stage_seconds(work, count, latency); };
  const std::string measured = fmt::format("messages take {:.2g} us", 1e6 * latency);
  if (chosen == 1)
    return {1, fmt::format("ranks: 1 of {} takes all steps, the others wait: {}, more than sharing would save "
                           "(-step_ranks all shares nevertheless)",
                           ranks, measured)};
  std::string note = fmt::format("ranks: {} of {} take the steps, {:.2g} times as fast as one where each has a core",
                                 chosen, ranks, gain(chosen));
  if (best != chosen) note += fmt::format("; {} would be fastest, {:.2g} times", best, gain(best));
  return {chosen, note + fmt::format(" ({})", measured)};
}

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
