// Runs on the first ranks only, while the others wait without use of a processor.
#pragma once

#include <mpi.h>

#include <functional>

namespace traverse::run {

/// Collective. Runs `work` on the first `count` ranks of comm in a separate communicator. Returns its status on all
/// ranks. An exception is thrown on the working ranks; the others get its status.
int run_on_first(MPI_Comm comm, int count, const std::function<int(MPI_Comm)>& work);

}  // namespace traverse::run
