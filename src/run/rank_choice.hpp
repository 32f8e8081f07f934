// Model of the computing time of steps, used by -describe, for the cost limit of trial runs, for the order of runs and
// for the number of ranks. It counts operations, so that no decision depends on the clock. The times were measured on
// the processor of doc/performance.md; benchmarks/check_estimates.py compares them with measurements.
//
// The number of ranks of a single run follows from the size of the scene and the measured latency of messages between
// the ranks (doc/scaling.md). The run is on the first ranks only, while the others wait without use of a processor.
#pragma once

#include <mpi.h>

#include <functional>
#include <memory>
#include <string>

#include "coupling/train_sharing.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Number of steps with the cost of a factorisation for a new step length.
inline constexpr double steps_per_factorisation = 30.0;

/// Unknowns of the bridge with this number of elements in its longest span (of the rail in a sleeper bay); elements =
/// 0: the present number, or about the number that will be chosen. 0 without a bridge.
double unknowns_of(const scene::Scene& scene, int elements = 0);
/// Computing time of one unknown in a stage, s.
double unknown_seconds(const scene::Scene& scene);
/// Computing time of a step of one run, s, by a method of -ts_type; by the default one if it is empty or one of
/// PETSc's. Vehicles whose model is open are assumed linear if their speed is constant. moving: the active part of the
/// unknowns.
double step_seconds(const scene::Scene& scene, const std::string& method = {}, int elements = 0, double moving = 1.0);
/// Computing time of a run's stage in a batch, s.
double batch_stage_seconds(const scene::Scene& scene, double elements);
/// Computing time of an instant of an exact solution by modes, s; coupled: dampers couple the modes.
double modal_instant_seconds(const scene::Scene& scene, double modes, bool coupled);
/// Computing time of such an instant of a single run, with nodal vectors and energies, s.
double modal_sample_seconds(double modes, double unknowns, bool coupled);

/// Work of a stage.
struct StageWork {
  double unknowns = 0.0;             // unknowns of the structure in the steps
  double seconds_per_unknown = 0.0;  // s, for one of the unknowns
  double vehicles = 0.0;             // vehicles that the ranks share
  bool cut = true;  // whether the ranks share the unknowns; false for the few active unknowns on a long bridge
  std::string single_rank_reason;  // the reason for one rank, in words; empty: ranks may share the steps
};
StageWork stage_work(const scene::Scene& scene);

/// Duration of a stage on `ranks` ranks, s. latency: duration of a message between two ranks, s.
double stage_seconds(const StageWork& work, int ranks, double latency);
/// The number of ranks, at most `most`, with the shortest stage; fewer if more ranks gain little.
int best_ranks(const StageWork& work, int most, double latency);

/// Collective; the same on every rank. The latency of a message between all ranks, divided by its number of stages, s:
/// the median of several messages between ranks that compute meanwhile, as in a step, because these may have to share
/// their processors.
double message_latency(MPI_Comm comm);

struct RankChoice {
  int ranks = 1;     // ranks that compute the steps
  std::string note;  // one line; empty on one rank
};
/// Collective; the same on every rank.
RankChoice choose_ranks(MPI_Comm comm, const scene::Scene& scene);

/// Whether ranks can share the trains of a run (coupling/train_sharing.hpp): several linear trains of prescribed speed
/// on separate spans without a deformation of their own, in steps of the program's own methods that do not end at the
/// kinks of the surface and whose lengths are not controlled.
bool shares_trains(const scene::Scene& scene);

/// The ranks that wait while the first rank of comm works.
class WaitingRanks {
 public:
  explicit WaitingRanks(MPI_Comm comm) : comm_(comm) {}
  MPI_Comm comm() const { return comm_; }  // of all of them, with the working one
  /// On the working rank: the others take part in a run by this model, which the working rank ends (serve_trains).
  void call(const scene::NumericalModel& model);

 private:
  MPI_Comm comm_;
};

/// Calls the waiting ranks if they can share the trains of the scene; null: they cannot, or there are none.
std::unique_ptr<coupling::TrainSharing> call_to_share(WaitingRanks* waiting, const scene::Scene& scene);

/// Collective. Runs `work` on the first `count` ranks of comm in a separate communicator. Returns its status on all
/// ranks. An exception is thrown on the working ranks; the others get its status. With one working rank the others can
/// be called meanwhile: they execute `serve` with the model.
int run_on_first(MPI_Comm comm, int count, const std::function<int(MPI_Comm, WaitingRanks*)>& work,
                 const std::function<void(MPI_Comm, const scene::NumericalModel&)>& serve);

}  // namespace traverse::run
