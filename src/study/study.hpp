// Studies and sweeps: one scene with any of its numbers varied, or many trains at many speeds, the runs shared among
// the ranks.
#pragma once

#include <mpi.h>

#include "results/place.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. Of a scene with a study or a sweep: computes every run on one rank, writes their numbers to `place` as
/// they come, and prints extremes, statistics and verdicts. The same results on any number of ranks. A run that fails
/// is named, what was computed until then is in the file, and the error thrown. Returns the exit status as `run` does.
int run_study(MPI_Comm comm, const Scene& scene, results::Place place);

}  // namespace traverse::app
