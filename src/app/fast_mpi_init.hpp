// Settings of MPI before its initialisation, with which a single process starts fast.
#pragma once

namespace traverse::app {

/// Call before MPI_Init. Sets the variables that are not set in the environment.
void start_lightly();
/// Call after MPI_Init. Removes the variable that would prevent this process from starting mpirun.
void started();

}  // namespace traverse::app
