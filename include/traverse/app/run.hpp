// Runs a scene: its check, its analysis in time or at rest, its modes, or the runs of its sweep or study.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. Carries out the scene's analysis, writes the results file and the summary. Throws Error; results
/// written until then stay readable. Returns the exit status: 0, or 128 + signal when a signal ended the run.
int run(MPI_Comm comm, const Scene& scene);

}  // namespace traverse::app
