// ts_type modal, which PETSc does not have: a TS whose step is the exact motion of modes under moving forces.
//
// y = (q, q'), the same on every rank. A step of any length, also with events inside it, is computed in closed form;
// there is no right-hand side, no stage and no error estimate.
#pragma once

#include "base/petsc.hpp"
#include "integrate/modal_motion.hpp"

namespace traverse::integrate {

/// A TS of type modal on `motion`, which must outlive it, at the motion's time. Reads PETSc's options.
base::Handle<TS> make_modal_ts(ModalMotion& motion);

}  // namespace traverse::integrate
