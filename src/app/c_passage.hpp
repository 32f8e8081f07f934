// The passages of the C interface.
#pragma once

#include "step_by_step.hpp"
#include "traverse/problem.hpp"
#include "traverse/traverse.h"

namespace traverse::app {

/// A new handle of a passage at t = 0; its vehicles are mechanisms unless the problem says otherwise.
traverse_passage* open_passage(Problem problem);
/// The run of an open passage; InputError for NULL and for a closed one.
StepByStep& require_open(const traverse_passage* passage);

}  // namespace traverse::app
