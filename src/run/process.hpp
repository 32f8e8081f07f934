// What runs and sweeps share towards the world outside: the file's attributes, a disk or a memory that is full.
#pragma once

#include <mpi.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "traverse/base/error.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

std::vector<std::pair<std::string, std::string>> attributes(MPI_Comm comm, const Scene& scene);
/// Rank 0 of comm says what was modelled.
void print_notes(MPI_Comm comm, const std::vector<std::string>& notes);
/// One line on standard error, where that can be written.
void complain(const Error& error);
/// A file that cannot grow, which the writing rank alone knows: the others are not to wait for it.
[[noreturn]] void leave_together(MPI_Comm comm, const Error& error);

/// Any failure as one that ends the program with a message: of memory, what to make smaller.
Error as_error(const std::exception& failure);

}  // namespace traverse::app
