// A run by some of the ranks, the first ones, while the others wait without taking a processor's time.
#pragma once

#include <mpi.h>

#include <functional>

namespace traverse::app {

/// Collective. Runs `work` on the first `count` ranks of comm, which get a communicator of their own. Returns its
/// status on all ranks; what it throws is thrown there, and is its status to the others.
int run_on_first(MPI_Comm comm, int count, const std::function<int(MPI_Comm)>& work);

}  // namespace traverse::app
