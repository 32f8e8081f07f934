// The option -describe: the model of a scene, its estimated cost and unusual input, without time steps.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::check {

/// Collective. Prints on the first rank; with -output_quiet only unusual input. Throws the errors of the run before its
/// first step. Returns the exit status, 0.
int run_check(MPI_Comm comm, const scene::Scene& given);

}  // namespace traverse::check
