// Checks whether the theory of small displacements is valid for the bridge's deflection.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Prints a warning on the first rank if the deflection (m) is a large part of the longest span. SolverError if it is
/// impossibly large: then some quantity is not in SI units. The same on every rank.
void check_deflection(MPI_Comm comm, const scene::Scene& scene, double deflection);

}  // namespace traverse::run
