#include "process.hpp"

#include <fmt/format.h>
#include <petscversion.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "traverse/results/terminal.hpp"

namespace traverse::app {
namespace {

std::atomic<int> caught{0};
void catch_signal(int signal) { caught = signal; }

}  // namespace

void catch_signals() {
  std::signal(SIGINT, catch_signal);
  std::signal(SIGTERM, catch_signal);
}

int caught_signal() { return caught; }

int signal_on_any(MPI_Comm comm) {
  int ranks = 1, signal = caught_signal();
  MPI_Comm_size(comm, &ranks);
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, &signal, 1, MPI_INT, MPI_MAX, comm);
  return signal;
}

std::vector<std::pair<std::string, std::string>> attributes(MPI_Comm comm, const Scene& scene) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  return {{"program", "traverse"},
          {"version", TRAVERSE_VERSION},
          {"petsc_version", fmt::format("{}.{}.{}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR)},
          {"ranks", std::to_string(ranks)},
          {"scene", scene.name}};
}

void print_notes(MPI_Comm comm, const std::vector<std::string>& notes) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) results::print_modelled(notes);
}

void leave_together(MPI_Comm comm, const FileError& error) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  fmt::print(stderr, "traverse: {}\n", error.what());
  if (ranks > 1) MPI_Abort(comm, error.status());
  std::fflush(nullptr);
  std::_Exit(error.status());  // HDF5 may not survive closing what it could not write
}

}  // namespace traverse::app
