// Whether a bridge's deflection is one that the theory of small displacements can speak of.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// A note, printed on the first rank, where the deflection (m) is a large part of the longest span. SolverError where
/// it is beyond any bridge: some quantity is not in SI units. The same on every rank.
void check_deflection(MPI_Comm comm, const Scene& scene, double deflection);

}  // namespace traverse::app
