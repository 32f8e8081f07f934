// Chooses the number of ranks of a single run by a model of the duration of a step, from the size of the scene and the
// measured latency of messages between the ranks (doc/scaling.md), and runs on the first ranks only, while the others
// wait without use of a processor.
#pragma once

#include <mpi.h>

#include <functional>
#include <string>

#include "traverse/scene/scene.hpp"

namespace traverse::run {

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

/// Collective. Runs `work` on the first `count` ranks of comm in a separate communicator. Returns its status on all
/// ranks. An exception is thrown on the working ranks; the others get its status.
int run_on_first(MPI_Comm comm, int count, const std::function<int(MPI_Comm)>& work);

}  // namespace traverse::run
