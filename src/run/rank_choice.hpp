// How many ranks a single run is worth: a model of what a step takes on so many of them, from what the scene holds and
// what a message takes between the ranks at hand (doc/scaling.md).
#pragma once

#include <mpi.h>

#include <string>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// What a step's stages are made of.
struct StageWork {
  double unknowns = 0.0;  // of the structure, that are stepped
  double each = 0.0;      // s, a stage takes for one of these
  double vehicles = 0.0;  // that ranks share
  bool cut = true;        // ranks share the unknowns: not the few that move on a long bridge at rest
  std::string alone;      // why one rank takes all steps, in words; empty: ranks may share them
};
StageWork stage_work(const Scene& scene);

/// s, of a stage on so many ranks, with messages that take `latency` s between two of them.
double stage_seconds(const StageWork& work, int ranks, double latency);
/// The number of ranks, of those up to `most`, on which a stage takes least; fewer where more save next to nothing.
int best_ranks(const StageWork& work, int most, double latency);

/// Collective; the same on every rank. s, of a message between all ranks over its stops, the median of some: between
/// ranks that compute meanwhile, as in a step, since it is these that find their processors taken by others.
double message_latency(MPI_Comm comm);

struct RankChoice {
  int ranks = 1;     // that take the steps
  std::string said;  // one line; empty on one rank
};
/// Collective; the same on every rank.
RankChoice choose_ranks(MPI_Comm comm, const Scene& scene);

}  // namespace traverse::app
