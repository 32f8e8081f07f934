// One run of a scene: builds the model, integrates, records.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. Carries out the scene's analysis, writes the results file and the summary. Throws Error; results
/// written until then stay readable. Returns the exit status: 0, or 128 + signal when a signal ended the run.
int run(MPI_Comm comm, const Scene& scene);

}  // namespace traverse::app
