// What runs and sweeps share towards the world outside: signals, the file's attributes, a disk that is full.
#pragma once

#include <mpi.h>

#include <string>
#include <utility>
#include <vector>

#include "traverse/app/scene.hpp"
#include "traverse/base/error.hpp"

namespace traverse::app {

/// From now on SIGINT and SIGTERM are kept for `caught_signal`.
void catch_signals();
/// The signal that asks the run to end, or 0.
int caught_signal();
/// Collective. The signal of any rank of comm.
int signal_on_any(MPI_Comm comm);

std::vector<std::pair<std::string, std::string>> attributes(MPI_Comm comm, const Scene& scene);
/// Rank 0 of comm says what was modelled.
void print_notes(MPI_Comm comm, const std::vector<std::string>& notes);
/// A file that cannot grow, which the writing rank alone knows: the others are not to wait for it.
[[noreturn]] void leave_together(MPI_Comm comm, const FileError& error);

}  // namespace traverse::app
