// Screens a stock of bridges with a fleet of formations.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "results/place.hpp"
#include "screen/screen_file.hpp"

namespace traverse::screen {

/// Collective. Computes all bridges, dealt over the ranks, writes and prints the results. Returns the exit status.
int run(MPI_Comm comm, results::Place place, const Problem& problem, const std::vector<std::string>& notes);

/// What a screen will compute, one line each.
std::vector<std::string> description(const Problem& problem);

/// The scene of the passages of a formation over a bridge, as an options file. InputError if the names are unknown.
std::string pair_scene(const Problem& problem, const std::string& bridge, const std::string& formation);

}  // namespace traverse::screen
