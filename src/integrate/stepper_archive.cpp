// The archive of a stepper between two steps.
#include <petsc/private/tsimpl.h>  // previous time, rejections, and whether the next step is a first one

#include "arrays.hpp"
#include "integrate/second_order.hpp"
#include "integrate/stepper.hpp"

namespace traverse::integrate {

using base::check;

std::string Stepper::no_archive() const { return multistep_ ? "ts_type bdf keeps the steps before within PETSc" : ""; }

void Stepper::keep(base::Archive& archive) {
  if (archive.reads()) {
    if (settings_.kinks) system_.list_kinks(settings_.end_time, settings_.time_step);
    check(TSSetUp(ts_));
  }
  double end = settings_.end_time;
  archive.same(progress_, end, last_step_, next_step_, steps_);
  if (end != settings_.end_time) progress_.under_way = false;  // the target may have been the end
  if (step_control_) archive.same(*step_control_);
  archive.cache(known_, known_t_, known_y_, known_rate_);
  {
    Array y(y_);
    system_.keep(archive, y.data);
  }
  TS ts = ts_;
  bool started = second_order_ && has_started(ts), restarts = ts->steprestart == PETSC_TRUE;
  archive.same(ts->ptime, ts->ptime_prev, ts->time_step, ts->steps, ts->reject, restarts, started);
  ts->steprestart = restarts || (!archive.same_ranks() && !second_order_) ? PETSC_TRUE : PETSC_FALSE;
  if (second_order_) has_started(ts) = started;
}

}  // namespace traverse::integrate
