// A fit: options of a scene are estimated from measured frequencies and series by weighted least squares.
#pragma once

#include <mpi.h>

#include "results/place.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::fit {

/// Collective. For a scene with a fit: minimises the misfit, writes estimates, standard errors, correlations and
/// residuals to `place`, and prints them. The runs are distributed over the ranks; the results are the same on any
/// number of ranks. If a run fails, the error with its reason is thrown, and the file contains the results before it.
/// Returns the exit status.
int run_fit(MPI_Comm comm, const scene::Scene& scene, results::Place place);

}  // namespace traverse::fit
