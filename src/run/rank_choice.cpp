// Estimates computing times from the numbers of unknowns and bodies, with measured times for one of each. Measures the
// latency of MPI_Allreduce, estimates the duration of a stage on every number of ranks from unknowns, vehicles and
// messages, and selects the number above which more ranks gain too little. The ranks without work wait in a
// non-blocking barrier, which they test at increasing intervals.
#include "run/rank_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "base/broadcast.hpp"
#include "base/bytes.hpp"
#include "base/one_step_methods.hpp"
#include "beam/layered_track.hpp"
#include "integrate/integrators.hpp"
#include "run/process.hpp"

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

constexpr int called = -1;  // the waiting ranks are called

void exchange(base::Bytes& bytes, scene::NumericalModel& model) {
  bytes(model.modes, model.elements, model.step, model.method, model.vehicles, model.residual_limit,
        model.trials_lost_contact, model.window_tolerance, model.local_compliance, model.step_kinks, model.step_probes);
}

constexpr std::chrono::microseconds first_interval(100), longest_interval(10'000);

/// Waits until the working and the waiting ranks have reached this point, and broadcasts a number: the status of the
/// work, or `called`.
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

// Time for an unknown in a stage with its share of the step's end, s: continuous bridge, separate spans, bridge with a
// layered track.
constexpr double continuous = 7.2e-9, separate = 3.8e-9, layered = 16.6e-9;
constexpr double layered_unknowns = 5.0;   // number of unknowns in a column of a layered track
constexpr double elements_of_span = 20.0;  // if they are not chosen yet
// Time in a stage, s: constant part, for a body of a mechanism, for a body of a linear vehicle, for a probe.
constexpr double per_stage = 2e-6, per_body = 9.6e-7, per_linear_body = 1.6e-7, per_probe = 2e-8;
constexpr double per_contact_pair = 4e-8;   // of a mechanism: each of its contacts moves all others
constexpr double rough_track_factor = 3.0;  // factor for a rough track, where contacts need more iterations
// Time for a run's stage in a batch, s: for a vehicle, for an element.
constexpr double per_lane_vehicle = 1e-7, per_lane_element = 5e-9;
// Time for an instant by modes, s: for a mode, for a mode at a probe; factor for dampers that couple the modes. In a
// single run: constant part, for a mode with its energies, for a mode at an unknown.
constexpr double per_mode = 2e-9, per_mode_and_probe = 4e-10, coupled_factor = 8.0;
constexpr double per_sample = 3e-6, per_mode_with_energy = 5e-8, per_mode_and_unknown = 1e-9;

double bodies_of(const scene::Scene& scene) {
  double bodies = 0.0;
  for (const int type : scene.train.vehicles)
    bodies += static_cast<double>(scene.vehicles[static_cast<std::size_t>(type)].mechanism.bodies.size());
  return bodies;
}

/// The pairs of contacts of one mechanism, which are many in a chain on rollers.
double contact_pairs_of(const scene::Scene& scene) {
  double pairs = 0.0;
  for (const int type : scene.train.vehicles)
    pairs += std::pow(static_cast<double>(scene.vehicles[static_cast<std::size_t>(type)].wheels.size()), 2);
  return pairs;
}

double roughness_of(const scene::Scene& scene) { return scene.profile.level() ? 1.0 : rough_track_factor; }

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
  if (shares_trains(scene)) return {1, fmt::format("ranks: {} share the {} trains", ranks, scene.train.courses.size())};
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

bool shares_trains(const scene::Scene& scene) {
  if (!scene.beam || scene.all_ranks || scene.analysis != options::Analysis::transient) return false;
  const beam::BeamModel& beam = *scene.beam;
  const bool plain_bridge = beam.all_separate() && beam.spans.size() > 1 && !beam.track && !beam.nonlinear() &&
                            !beam.strained() && beam.dampers.empty() && !scene.self_weight &&
                            scene.support_motion.empty() && scene.support_motion_along.empty();
  const scene::NumericalModel& model = scene.model;
  const bool by_window = model.modes == 0 && model.window_tolerance != 0.0 && !model.step_kinks;
  const bool only_trains = scene.load.forces.empty() && scene.train.courses.size() > 1 &&
                           std::all_of(scene.train.courses.begin(), scene.train.courses.end(),
                                       [](const train::Course& c) { return c.drive == train::Drive::constant; });
  const bool of_all_wheels = scene.output.contact_points || scene.output.profile != 0.0;
  const bool own_steps =
      integrate::own_method(model.method).has_value() && std::ranges::none_of(scene.options, [](const auto& option) {
        return option.first == "ts_adapt_type" && option.second != "none";
      });
  return plain_bridge && by_window && only_trains && !of_all_wheels && own_steps &&
         model.vehicles == scene::VehicleModel::linear;
}

void WaitingRanks::call(const scene::NumericalModel& model) {
  base::Bytes bytes;
  scene::NumericalModel copy = model;
  exchange(bytes, copy);
  synchronise(comm_, called);
  base::broadcast(comm_, bytes.written(), 0);
}

std::unique_ptr<coupling::TrainSharing> call_to_share(WaitingRanks* waiting, const scene::Scene& scene) {
  if (waiting == nullptr || !shares_trains(scene)) return nullptr;
  waiting->call(scene.model);
  return std::make_unique<coupling::TrainSharing>(waiting->comm());
}

int run_on_first(MPI_Comm comm, int count, const std::function<int(MPI_Comm, WaitingRanks*)>& work,
                 const std::function<void(MPI_Comm, const scene::NumericalModel&)>& serve) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  if (count >= ranks) return work(comm, nullptr);
  MPI_Comm active = MPI_COMM_NULL;
  MPI_Comm_split(comm, rank < count ? 0 : MPI_UNDEFINED, rank, &active);
  if (active == MPI_COMM_NULL) {
    const DeferredSignals handlers;  // the working ranks end the run in order
    int status = synchronise(comm, 0);
    for (; status == called; status = synchronise(comm, 0)) {
      scene::NumericalModel model;
      const std::string text = base::broadcast(comm, std::string(), 0);
      base::Bytes bytes(text);
      exchange(bytes, model);
      serve(comm, model);
    }
    return status;
  }
  int status = 0;
  WaitingRanks waiting(comm);
  try {
    status = work(active, count == 1 ? &waiting : nullptr);
  } catch (const std::exception& failure) {
    synchronise(comm, as_error(failure).status());
    MPI_Comm_free(&active);
    throw;
  }
  synchronise(comm, status);
  MPI_Comm_free(&active);
  return status;
}

double unknowns_of(const scene::Scene& scene, int elements) {
  if (!scene.beam) return 0.0;
  const beam::BeamModel& beam = *scene.beam;
  const auto spans = static_cast<double>(beam.spans.size());
  if (beam.track) {
    const int present = beam.track->elements_per_bay;
    return layered_unknowns * beam::rail_mesh(beam).elements * (elements > 0 ? elements : present) / present;
  }
  const double per_node = beam.axial ? 3.0 : 2.0;
  if (elements > 0) {
    const double longest = *std::max_element(beam.spans.begin(), beam.spans.end());
    return per_node * (beam.length() / longest * elements + spans);
  }
  if (scene.mesh_open) return per_node * elements_of_span * spans;
  double all = 0.0;
  for (const int count : beam.elements) all += count;
  return per_node * (all + spans);
}

double unknown_seconds(const scene::Scene& scene) {
  if (!scene.beam) return 0.0;
  if (scene.beam->track) return layered;
  return scene.beam->all_separate() && scene.beam->spans.size() > 1 ? separate : continuous;
}

double step_seconds(const scene::Scene& scene, const std::string& method, int elements, double moving) {
  const base::MethodRow* row = base::find_method(method);
  const double stages = (row == nullptr ? base::methods().front() : *row).solves();
  const bool linear = scene.model.vehicles == scene::VehicleModel::linear ||
                      (scene.model.vehicles == scene::VehicleModel::automatic && scene.beam && scene.train.driven());
  const double body = linear ? per_linear_body : per_body;
  const double contacts = linear ? 0.0 : per_contact_pair * contact_pairs_of(scene);
  const double probes = per_probe * static_cast<double>(scene.output.probes.size());
  return stages * (roughness_of(scene) * (per_stage + body * bodies_of(scene) + contacts) + probes +
                   moving * unknown_seconds(scene) * unknowns_of(scene, elements));
}

double batch_stage_seconds(const scene::Scene& scene, double elements) {
  return roughness_of(scene) *
         (per_lane_vehicle * static_cast<double>(scene.train.vehicles.size()) + per_lane_element * elements);
}

double modal_instant_seconds(const scene::Scene& scene, double modes, bool coupled) {
  const auto probes = static_cast<double>(scene.output.probes.size());
  return (coupled ? coupled_factor : 1.0) * modes * (per_mode + per_mode_and_probe * probes);
}

double modal_sample_seconds(double modes, double unknowns, bool coupled) {
  return per_sample +
         modes * ((coupled ? coupled_factor : 1.0) * per_mode_with_energy + per_mode_and_unknown * unknowns);
}

}  // namespace traverse::run
