// A study: one scene with any of its numbers varied, its runs shared among the ranks.
#pragma once

#include <mpi.h>

#include "results/place.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. Computes every run on one rank, writes their numbers to `place` as they come, and prints extremes and
/// statistics. The same results on any number of ranks. A run that fails is named, what was computed until then is in
/// the file, and the error thrown. Returns the exit status as `run` does.
int run_study(MPI_Comm comm, const Scene& scene, results::Place place);

}  // namespace traverse::app
