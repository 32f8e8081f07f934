// A run in time with its observer, its recording and its summary.
#pragma once

#include <string>

#include "analyses.hpp"

namespace traverse::app {

/// Whether a run must be repeated, and how. mechanisms: the residual of linear vehicles exceeded
/// NumericalModel::residual_limit; shorter_steps: StepTooLong was thrown.
enum class Retry { none, mechanisms, shorter_steps };

struct RunEnd {
  int status = 0;  // exit status of the program if the run is not repeated
  Retry again = Retry::none;
  std::string why;    // message of StepTooLong, for shorter_steps
  double step = 0.0;  // s, longest computed time step, for shorter_steps
};

/// Collective. Computes the motion in time, or the static equilibrium under the loads at t = 0, and writes results and
/// summary. Throws InputError, SolverError and FileError, with which the program ends. repeated: stored in checkpoints.
/// may_shorten: StepTooLong is not thrown but returned as shorter_steps.
RunEnd run_once(Job& job, results::Repeated repeated, bool may_shorten);

}  // namespace traverse::app
