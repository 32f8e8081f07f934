// Time integrators in second-order form as PETSc TS types: "esdirk4" and "genalpha". They take the steps of
// System::step_motion, without SNES and without vectors of stages in PETSc; everything else (time, step, options,
// monitors) is TS's own. Steps are as long as TSSetTimeStep says; one whose stages have no solution is tried again, a
// quarter as long, and one that a TSAdapt finds too inaccurate as long as that says.
#pragma once

#include <petscts.h>

#include "traverse/coupling/system.hpp"
#include "traverse/integrate/step_ladder.hpp"

namespace traverse::integrate {

inline constexpr const char* esdirk4_type = "esdirk4";
inline constexpr const char* genalpha_type = "genalpha";

inline constexpr const char* ladder_adapt = "ladder";  // a TSAdapt type, for esdirk4 alone

/// Makes the types known to PETSc; more than once does no harm.
void register_second_order();
/// Whether a TS is of one of these types.
bool is_second_order(TS ts);
/// What such a TS integrates; before its first step. Its solution is y of the system.
void set_system(TS ts, coupling::System& system);
/// What such a TS with the ladder for its TSAdapt takes its steps from: those with an error above TS's relative
/// tolerance are taken again, shorter.
void set_ladder(TS ts, StepLadder& ladder);

}  // namespace traverse::integrate
