// What the functions of the C interface share: errors become a status and one line, and passages have handles.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "process_start.hpp"
#include "run/process.hpp"
#include "step_by_step.hpp"
#include "traverse/base/error.hpp"
#include "traverse/problem.hpp"
#include "traverse/traverse.h"

namespace traverse::app {

/// The message of the last call of the C interface that failed.
std::string& last_error();

/// Runs `body`. If it throws, stores the message in last_error and returns the status of the exception; otherwise 0.
template <class Body>
int call_and_catch(Body&& body) {
  const OneThreadOfBlas one_thread;
  try {
    body();
    return 0;
  } catch (const std::exception& failure) {
    const Error error = run::as_error(failure);
    last_error() = error.what();
    return error.status();
  }
}

/// Returns the pointer; throws InputError if it is NULL.
template <class T>
T* require_not_null(T* pointer, const char* what) {
  if (pointer == nullptr) throw InputError(std::string(what) + " is NULL");
  return pointer;
}

/// Starts PETSc, SLEPc and MPI, which end with the process.
void start_libraries(const std::vector<std::string>& petsc_words = {});

/// A new handle of a passage at t = 0; its vehicles are mechanisms unless the problem says otherwise.
traverse_passage* open_passage(Problem problem);
/// The run of an open passage; InputError for NULL and for a closed one.
StepByStep& require_open(const traverse_passage* passage);

}  // namespace traverse::app
