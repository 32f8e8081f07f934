// Functions that single runs and studies share: the attributes of the file, messages, and the exit after a failure.
#pragma once

#include <mpi.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "traverse/base/error.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

std::vector<std::pair<std::string, std::string>> attributes(MPI_Comm comm, const scene::Scene& scene);
/// Rank 0 of comm prints the description of the model, without unusual input, which is printed before.
void print_notes(MPI_Comm comm, const scene::Scene& scene, const std::vector<std::string>& notes);
/// Prints one line on standard error, if possible.
void print_error(const Error& error);
/// Ends all ranks if a file cannot be written. Only the writing rank detects this, and the others would wait for it.
[[noreturn]] void leave_together(MPI_Comm comm, const Error& error);

/// Converts any failure to an error with a message and an exit status; for lack of memory the message lists how to
/// reduce the scene.
Error as_error(const std::exception& failure);

}  // namespace traverse::run
