// A passage that is watched, recorded and summed up.
#pragma once

#include <string>

#include "analyses.hpp"

namespace traverse::app {

/// Whether a run has to be taken again, and how. mechanisms: linear vehicles were out of balance by more than
/// NumericalModel::residual_limit; shorter_steps: StepTooLong.
enum class Retry { none, mechanisms, shorter_steps };

struct RunEnd {
  int status = 0;  // of the program, where the run is not taken again
  Retry again = Retry::none;
  std::string why;    // of shorter_steps: the message of StepTooLong
  double step = 0.0;  // s, of these: the longest step that was taken
};

/// Collective. Computes the motion in time, or rest where the loads stand, and writes results and summary. InputError,
/// SolverError and FileError as the program ends with. repeated: which checkpoints note; may_shorten: StepTooLong is
/// not thrown but returned as shorter_steps.
RunEnd run_once(Job& job, results::Repeated repeated, bool may_shorten);

}  // namespace traverse::app
