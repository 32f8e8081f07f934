// The state of a stepper between two steps.
#include <petsc/private/tsimpl.h>  // the time before, rejections, and whether the next step is a first one

#include "arrays.hpp"
#include "integrate/second_order.hpp"
#include "integrate/stepper.hpp"

namespace traverse::integrate {

using base::check;

std::string Stepper::no_archive() const { return multistep_ ? "ts_type bdf keeps the steps before within PETSc" : ""; }

void Stepper::keep(base::Archive& archive) {
  if (archive.reads()) {
    if (settings_.corners) system_.expect_corners(settings_.end_time, settings_.time_step);
    check(TSSetUp(ts_));
  }
  double end = settings_.end_time;
  archive.same(way_, end, last_step_, next_step_, steps_);
  if (end != settings_.end_time) way_.under_way = false;  // the target may have been the end
  if (ladder_) archive.same(*ladder_);
  archive.cache(known_, known_t_, known_y_, known_rate_);
  {
    Array y(y_);
    system_.keep(archive, y.data);
  }
  TS ts = ts_;
  bool started = second_order_ && has_started(ts), restarts = ts->steprestart == PETSC_TRUE;
  archive.same(ts->ptime, ts->ptime_prev, ts->time_step, ts->steps, ts->reject, restarts, started);
  ts->steprestart = restarts || (!archive.alike() && !second_order_) ? PETSC_TRUE : PETSC_FALSE;
  if (second_order_) has_started(ts) = started;
}

}  // namespace traverse::integrate
