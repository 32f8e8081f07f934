// Registers the TS type with PETSc and copies the exact modal coordinates and velocities into its solution vector after
// each step.
#include "ts_modal.hpp"

#include <petsc/private/tsimpl.h>  // a type of TS

#include <algorithm>
#include <limits>

#include "traverse/options/input.hpp"

namespace traverse::integrate {
namespace {

using base::check;

constexpr const char* type_name = "modal";

ModalMotion& motion_of(TS ts) { return *static_cast<ModalMotion*>(ts->data); }

void copy_solution(const ModalMotion& motion, Vec y) {
  double* values = nullptr;
  check(VecGetArray(y, &values));
  std::copy(motion.q().begin(), motion.q().end(), values);
  std::copy(motion.rate().begin(), motion.rate().end(), values + motion.q().size());
  check(VecRestoreArray(y, &values));
}

PetscErrorCode step_modal(TS ts) {
  return base::guard([&] {
    motion_of(ts).advance(ts->ptime + ts->time_step);
    ts->ptime += ts->time_step;
    copy_solution(motion_of(ts), ts->vec_sol);
  });
}

PetscErrorCode view(TS ts, PetscViewer viewer) {
  return PetscViewerASCIIPrintf(viewer, "  %d modes, exact in time\n", static_cast<int>(motion_of(ts).q().size()));
}

PetscErrorCode destroy_modal(TS ts) {  // the motion belongs to its owner
  ts->data = nullptr;
  return base::success;
}

PetscErrorCode create_modal(TS ts) {
  ts->ops->step = step_modal;
  ts->ops->view = view;
  ts->ops->destroy = destroy_modal;
  ts->usessnes = PETSC_FALSE;
  ts->default_adapt_type = TSADAPTNONE;
  return base::success;
}

}  // namespace

base::Handle<TS> make_modal_ts(ModalMotion& motion) {
  check(TSRegister(type_name, create_modal));
  base::Handle<TS> ts;
  base::Handle<Vec> y;
  const auto size = static_cast<PetscInt>(2 * motion.q().size());
  check(VecCreateSeq(PETSC_COMM_SELF, size, y.out()));
  copy_solution(motion, y);
  check(TSCreate(PETSC_COMM_SELF, ts.out()));
  check(TSSetType(ts, type_name));
  static_cast<TS>(ts)->data = &motion;
  check(TSSetSolution(ts, y));
  check(TSSetTime(ts, motion.time()));
  check(TSSetMaxSteps(ts, std::numeric_limits<PetscInt>::max() - 1));
  check(TSSetMaxTime(ts, std::numeric_limits<double>::max()));
  check(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_STEPOVER));
  try {
    check(TSSetFromOptions(ts));
  } catch (const SolverError& error) {
    options::refuse_by_petsc(error.what());
  }
  return ts;
}

}  // namespace traverse::integrate
