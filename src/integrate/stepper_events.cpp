// Steps that end at events of the motion, which are contacts that open or close and wheels that turn about kinks, and
// the archive of a stepper between two steps.
#include <petsc/private/tsimpl.h>  // previous time, rejections, and whether the next step is a first one

#include <cmath>

#include "arrays.hpp"
#include "integrate/second_order.hpp"
#include "integrate/stepper.hpp"

namespace traverse::integrate {
namespace {

using base::check;

constexpr int most_trials = 40;      // limit of trials for the end of a step at a contact event
constexpr int most_kink_trials = 3;  // limit of trials for the end of a step at a kink event

}  // namespace

// The next event within `remaining` s at which a wheel begins or ends to turn about a kink of the surface, if any.
// Multistep methods ignore kinks, because the restart with a short step costs them more. The step-size control ignores
// them, because its error estimate includes the kink and it uses only the lengths of its levels.
std::optional<coupling::KinkEvents::KinkEvent> Stepper::next_kink(double from, double remaining) {
  if (!settings_.kinks || multistep_ || step_control_) return std::nullopt;
  ReadArray y(y_);
  return system_.next_kink(from, remaining, y.data);
}

// Sets the vehicles to the end of the step.
void Stepper::set_vehicles(double t) {
  ReadArray y(y_);
  system_.set_vehicles(t, y.data);
}

// Repeats the step from `from` with another end. Returns the new time.
double Stepper::step_again(double from, double end) {
  if (second_order_) {
    Array y(y_);
    system_.reject_step(y.data);
  } else {
    check(VecCopy(before_, y_));
  }
  check(TSSetTime(ts_, from));
  check(TSRestartStep(ts_));
  known_ = false;
  const double reached = step_to(from, end);
  set_vehicles(reached);
  return reached;
}

// If a contact opens or closes in the step from `from` to `full`, repeats the step until it ends just after the first
// opening or just before the first closing, because the onset of a stiff contact needs short steps. Returns the new
// time.
double Stepper::locate_contact_change(double from, double full) {
  set_vehicles(full);
  auto change = system_.contacts().change(full, settings_.contact_tolerance);
  if (!change) return full;
  coupling::ContactEventLocator locator(system_, *change, from, full, settings_.contact_tolerance);
  double at = full;
  for (int i = 0; i < most_trials && !locator.found(); ++i) {
    at = step_again(from, locator.trial());
    locator.update(at, system_.contacts().change(at, settings_.contact_tolerance));
  }
  return at != locator.end() ? step_again(from, locator.end()) : at;
}

// Repeats the step from `from` to `at` if the wheel turns about its kink at another time than predicted.
double Stepper::end_at_kink(double from, double at, const coupling::KinkEvents::KinkEvent& kink_event) {
  set_vehicles(at);
  for (int i = 0; i < most_kink_trials; ++i) {
    double found = 0.0;
    {
      ReadArray y(y_);
      found = system_.time_of(kink_event, at, y.data);
    }
    if (!(std::abs(found - at) > kink_event.tolerance) || !(found > from) || !std::isfinite(found)) break;
    at = step_again(from, found);
  }
  return at;
}

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
