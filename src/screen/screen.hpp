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

/// The memory that a rank needs, bytes: the program, the tables, and one row.
double memory_of(const Problem& problem);

/// The scene of a formation over a bridge as an options file, as screen_pair asks for it: moving forces at all speeds,
/// or vehicles on a rough track at the permitted speed. InputError if the names are unknown.
std::string pair_scene(const Problem& problem);

}  // namespace traverse::screen
