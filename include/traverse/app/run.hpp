// Runs a scene: -describe, one analysis (in time, static, or natural modes), a sweep or a study.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. Carries out the scene's analysis and writes the results file and the summary. Throws Error; results
/// written before remain readable. Returns the exit status: 0, or 128 + signal if a signal ended the run.
int run(MPI_Comm comm, const Scene& scene);

}  // namespace traverse::app
