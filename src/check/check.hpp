// -check: what a scene is, what it would take and unusual input in it, without a run.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. Prints on the first rank; with -output_quiet only unusual input. Throws what the run itself would
/// throw before its first step. Returns the exit status, 0.
int run_check(MPI_Comm comm, const Scene& given);

}  // namespace traverse::app
