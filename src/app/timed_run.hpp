// A passage that is watched, recorded and summed up.
#pragma once

#include <string>

#include "analyses.hpp"

namespace traverse::app {

/// How a run has to be taken again: by the mechanisms, where linear vehicles have left out more than they may.
enum class Retry { none, mechanisms, shorter_steps };

struct RunEnd {
  int status = 0;  // of the program, where the run is not taken again
  Retry again = Retry::none;
  std::string why;    // the steps were too long
  double step = 0.0;  // s: which
};

/// Collective. The motion in time, or rest where the loads stand. with_mechanisms: the run is taken again that way;
/// may_shorten: it may be taken again with shorter steps, else StepTooLong is thrown as any other error.
RunEnd run_once(Job& job, bool with_mechanisms, bool may_shorten);

}  // namespace traverse::app
