// File attributes with versions and ranks, the exit of all MPI ranks after a failed write, and the conversion of C++
// exceptions to error messages with an exit status.
#include "run/process.hpp"

#include <fmt/format.h>
#include <petscversion.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>

#include "base/notes.hpp"
#include "results/terminal.hpp"

namespace traverse::run {

std::vector<std::pair<std::string, std::string>> attributes(MPI_Comm comm, const scene::Scene& scene) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  return {{"program", "traverse"},
          {"version", TRAVERSE_VERSION},
          {"petsc_version", fmt::format("{}.{}.{}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR)},
          {"ranks", std::to_string(ranks)},
          {"scene", scene.name}};
}

void print_notes(MPI_Comm comm, const scene::Scene& scene, const std::vector<std::string>& notes) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank != 0) return;
  const auto said_before = [&](const std::string& note) {
    return std::find(scene.unusual.begin(), scene.unusual.end(), note) != scene.unusual.end();
  };
  std::vector<std::string> lines;
  for (const std::string& note : notes)
    if ((scene.verbose || !base::is_detail(note)) && !said_before(note)) lines.push_back(base::text_of_note(note));
  results::print_modelled(lines);
}

void print_error(const Error& error) { (void)std::fputs(fmt::format("traverse: {}\n", error.what()).c_str(), stderr); }

void leave_together(MPI_Comm comm, const Error& error) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  print_error(error);
  if (ranks > 1) MPI_Abort(comm, error.status());
  std::fflush(nullptr);
  std::_Exit(error.status());  // HDF5 may crash when it closes a file that it could not write
}

Error as_error(const std::exception& failure) {
  if (const auto* error = dynamic_cast<const Error*>(&failure)) return *error;
  const bool memory = dynamic_cast<const std::bad_alloc*>(&failure) != nullptr ||
                      dynamic_cast<const std::length_error*>(&failure) != nullptr;
  if (memory)
    return {
        "there is not enough memory for this scene; make it smaller: fewer elements (beam_elements_per_span, "
        "track_elements_per_bay, track_approach), probes (output_probes), vehicles, forces, modes (modes_count, "
        "model_modes) or runs of a sweep",
        5};
  return {std::string("internal error, please report it: ") + failure.what(), 70};
}

}  // namespace traverse::run
