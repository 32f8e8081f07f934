// Measures the latency of MPI_Allreduce, estimates the time of a stage on every number of ranks from unknowns, vehicles
// and messages, and selects the number beyond which more ranks gain too little.
#include "run/rank_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "run/step_cost.hpp"

namespace traverse::app {
namespace {

// s, of a coach's stage: what its rank does alone, and its contacts, which every rank solves with all others.
constexpr double vehicle_alone = 3.0e-6, vehicle_contacts = 1.7e-6;
constexpr double messages = 9.0;         // in a stage, as counted on two ranks (doc/scaling.md)
constexpr double late = 0.5e-6;          // s, by which ranks come late to a message
constexpr double worth = 0.85;           // more ranks have to take less than that part of what fewer take
constexpr int most_told = 1024;          // ranks
constexpr int batches = 7, batch = 100;  // of messages that tell their latency
constexpr double pause = 2e-5;           // s, from one of these to the next, in which ranks compute

}  // namespace

StageWork stage_work(const Scene& scene) {
  StageWork work;
  if (!scene.beam) {
    work.vehicles = static_cast<double>(scene.train.vehicles.size());
    return work;
  }
  const beam::BeamModel& beam = *scene.beam;
  const bool spans_apart = beam.all_separate() && beam.spans.size() > 1;
  work.unknowns = unknowns_of(scene);
  work.each = unknown_seconds(scene);
  // Every rank steps all vehicles that are linear.
  work.vehicles = scene.model.vehicles == VehicleModel::linear ? 0.0 : static_cast<double>(scene.train.vehicles.size());
  work.cut = !(scene.model.rest_tolerance > 0.0 || (scene.model.rest_tolerance < 0.0 && spans_apart));
  if (scene.model.modes > 0)
    work.alone = "the modes' steps have no more in them than a message";
  else if (work.vehicles == 0.0 && !work.cut)
    work.alone = "the spans near linear vehicles have no more in them than a message";
  return work;
}

double stage_seconds(const StageWork& work, int ranks, double latency) {
  const double share = static_cast<double>(ranks);
  const double structure = work.unknowns * work.each / (work.cut ? share : 1.0);
  const double vehicles = vehicle_alone * std::ceil(work.vehicles / share) + vehicle_contacts * work.vehicles;
  return structure + vehicles + messages * (latency + late) * std::ceil(std::log2(share));
}

int best_ranks(const StageWork& work, int most, double latency) {
  int best = 1;
  if (!work.alone.empty()) return best;
  double least = stage_seconds(work, 1, latency);
  for (int ranks = 2; ranks <= most; ++ranks) {
    const double seconds = stage_seconds(work, ranks, latency);
    if (seconds > worth * least) continue;
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
  std::array<double, batches> taken{};
  for (double& seconds : taken) {
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
  std::nth_element(taken.begin(), taken.begin() + batches / 2, taken.end());
  double latency = taken[batches / 2] / std::ceil(std::log2(static_cast<double>(ranks)));
  MPI_Bcast(&latency, 1, MPI_DOUBLE, 0, comm);
  return latency;
}

RankChoice choose_ranks(MPI_Comm comm, const Scene& scene) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  if (ranks == 1) return {};
  const StageWork work = stage_work(scene);
  if (scene.all_ranks) return {ranks, fmt::format("ranks: all {} take the steps, as asked for", ranks)};
  if (!work.alone.empty())
    return {1, fmt::format("ranks: 1 of {} takes all steps, the others wait: {}", ranks, work.alone)};
  const double latency = message_latency(comm);
  const int taken = best_ranks(work, ranks, latency), best = best_ranks(work, most_told, latency);
  const auto gain = [&](int count) { return stage_seconds(work, 1, latency) / stage_seconds(work, count, latency); };
  const std::string measured = fmt::format("messages take {:.2g} us", 1e6 * latency);
  if (taken == 1)
    return {1, fmt::format("ranks: 1 of {} takes all steps, the others wait: {}, more than sharing would save "
                           "(-step_ranks all shares nevertheless)",
                           ranks, measured)};
  std::string said = fmt::format("ranks: {} of {} take the steps, {:.2g} times as fast as one where each has a core",
                                 taken, ranks, gain(taken));
  if (best != taken) said += fmt::format("; {} would be fastest, {:.2g} times", best, gain(best));
  return {taken, said + fmt::format(" ({})", measured)};
}

}  // namespace traverse::app
