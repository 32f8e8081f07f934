// The methods of one_step_methods.hpp as PETSc TS types, by their names. They take the steps of System::step_motion,
// without SNES and without vectors of stages in PETSc; everything else (time, step, options, monitors) is TS's own.
// Steps are as long as TSSetTimeStep says; one whose stages have no solution is tried again, a quarter as long, and one
// that a TSAdapt finds too inaccurate as long as that says.
#pragma once

#include <petscts.h>

#include "coupling/system.hpp"
#include "integrate/step_size_control.hpp"

namespace traverse::integrate {

inline constexpr const char* ladder_adapt = "ladder";  // a TSAdapt type, for methods that estimate their errors

/// Makes the types known to PETSc; more than once does no harm.
void register_second_order();
/// What such a TS integrates; before its first step. Its solution is y of the system.
void set_system(TS ts, coupling::System& system);
/// What such a TS with the ladder for its TSAdapt takes its steps from: those with an error above TS's relative
/// tolerance are taken again, shorter.
void set_ladder(TS ts, StepSizeControl& ladder);
/// Whether anybody watches the steps of a TS of any type.
bool has_monitors(TS ts);
/// Whether such a TS has taken a step, so that the next one goes on from it.
bool& has_started(TS ts);

}  // namespace traverse::integrate
