// A sweep: one scene at many speeds and with many trains of forces, its runs shared among the ranks.
#pragma once

#include <mpi.h>

#include "results/place.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. Runs every combination, each on one rank, writes the peaks to `place` and prints a table. The same
/// results on any number of ranks. A run that fails is named, what was computed until then is written, and the error
/// thrown. Returns the exit status as `run` does.
int run_sweep(MPI_Comm comm, const Scene& scene, results::Place place);

}  // namespace traverse::app
