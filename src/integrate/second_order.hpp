// The methods of one_step_methods.hpp as PETSc TS types, by their names, and access to the entries of PETSc vectors.
// System::step_motion computes their steps, without SNES and without vectors of stages in PETSc; TS manages everything
// else (time, step, options, monitors). TSSetTimeStep sets the length of steps. A step whose stages have no solution is
// repeated with a quarter of the length; a step that a TSAdapt rejects is repeated with the length that it selects.
#pragma once

#include <petscts.h>

#include "base/petsc.hpp"
#include "coupling/system.hpp"
#include "integrate/step_size_control.hpp"

namespace traverse::integrate {

/// Access to the entries of PETSc vectors within a scope.
struct Array {  // writable
  explicit Array(Vec v) : vec(v) { base::check(VecGetArray(v, &data)); }
  ~Array() { (void)VecRestoreArray(vec, &data); }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  Vec vec;
  double* data = nullptr;
};

struct ReadArray {
  explicit ReadArray(Vec v) : vec(v) { base::check(VecGetArrayRead(v, &data)); }
  ~ReadArray() { (void)VecRestoreArrayRead(vec, &data); }
  ReadArray(const ReadArray&) = delete;
  ReadArray& operator=(const ReadArray&) = delete;
  Vec vec;
  const double* data = nullptr;
};

inline constexpr const char* step_level_adapt = "ladder";  // a TSAdapt type with step-size levels, for methods that
                                                           // estimate their errors

/// Registers the types with PETSc; repeated calls have no effect.
void register_second_order();
/// Sets the system of such a TS, before its first step. The solution of the TS is y of the system.
void set_system(TS ts, coupling::System& system);
/// Sets the step-size control of such a TS, if its TSAdapt type is step_level_adapt. Steps with an error above the
/// relative tolerance of TS are repeated with a shorter step.
void set_step_size_control(TS ts, StepSizeControl& control);
/// Whether a TS of any type has monitors.
bool has_monitors(TS ts);
/// Whether such a TS has computed a step from which the next one continues.
bool& has_started(TS ts);

}  // namespace traverse::integrate
