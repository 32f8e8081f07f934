// Studies and sweeps: one scene with varied options, or many trains at many speeds. The runs are distributed over
// the ranks.
#pragma once

#include <mpi.h>

#include "results/place.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::study {

/// Collective. For a scene with a study or a sweep: computes every run on one rank, writes the results to `place` as
/// runs end, and prints extremes, statistics and verdicts. The results are the same on any number of ranks. If a run
/// fails, the error with the run's name is thrown, and the file contains the earlier results. Returns the exit status.
int run_study(MPI_Comm comm, const scene::Scene& scene, results::Place place);

}  // namespace traverse::study
