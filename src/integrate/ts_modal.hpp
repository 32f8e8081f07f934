// ts_type modal: what PETSc has none of, a TS whose step is the exact motion of modes under moving forces.
//
// y = (q, q'), the same on every rank. A step of any length ends where the closed form says, events inside it included;
// there is no right-hand side to evaluate, no stage and no error to control.
#pragma once

#include "base/petsc.hpp"
#include "integrate/modal_motion.hpp"

namespace traverse::integrate {

/// A TS of type modal on `motion`, which must outlive it, at the motion's time; PETSc's options are read.
base::Handle<TS> make_modal_ts(ModalMotion& motion);

}  // namespace traverse::integrate
