// Steps that end at events of the motion, which are contacts that open or close and wheels that turn about kinks, and
// the archive of a stepper between two steps. The interval that contains a change of contact is narrowed by trial
// steps: the next trial time is interpolated from penetration and penetration rate, and bisection replaces it where it
// converges slowly.
#include <petsc/private/tsimpl.h>  // previous time, rejections, and whether the next step is a first one

#include <algorithm>
#include <cmath>
#include <optional>

#include "coupling/system.hpp"
#include "integrate/stepper.hpp"
#include "second_order.hpp"

namespace traverse::integrate {
namespace {

/// Locates the end of a step in which a contact opens or closes: just after an opening, just before a closing. A guided
/// wheel leaves the beam while its force acts: a step ends just before that, and a very short one just after it.
class ContactEventLocator {
 public:
  /// `change` occurs between `from`, the last accepted instant, and `to`, the time that the vehicles are set to.
  ContactEventLocator(const coupling::System& system, const train::Change& change, double from, double to,
                      double tolerance);

  bool found() const { return found_; }
  /// The next end of the step to compute.
  double trial();
  /// Evaluates a step to `at`, which the vehicles are set to, with the change of contact that it contains.
  void update(double at, const std::optional<train::Change>& change);
  /// The time at which the step has to end, even if the search has failed.
  double end() const;

 private:
  contact::Kinematics current_kinematics() const;
  bool ends_before() const;
  double nearest() const;
  void end_at(double end);

  const coupling::System& system_;
  train::Change change_;
  double from_, full_end_;                                // start and end of the whole step
  double low_, high_;                                     // no change before low_, a change before high_
  contact::Kinematics low_kinematics_, high_kinematics_;  // kinematics of the contact at these times
  double tolerance_;
  double time_tolerance_;     // s, of this contact
  bool ends_before_ = false;  // whether the step ends just before the change
  bool found_ = false;
  double trial_ = 0.0;
  double end_;
};

ContactEventLocator::ContactEventLocator(const coupling::System& system, const train::Change& change, double from,
                                         double to, double tolerance)
    : system_(system),
      change_(change),
      from_(from),
      full_end_(to),
      low_(from),
      high_(to),
      low_kinematics_(system.contacts().separations().kinematics(change.contact)),
      high_kinematics_(current_kinematics()),
      tolerance_(tolerance),
      time_tolerance_(system.contacts().tolerance_of(change.contact, tolerance)),
      end_(to) {
  ends_before_ = ends_before();
  if (!ends_before_ && !change.hidden && to - change.time <= time_tolerance_) found_ = true;
}

bool ContactEventLocator::ends_before() const {
  const bool pulls = contact::pulls(system_.fleet().contact(change_.contact).law.kind);
  return change_.gain || (pulls && change_.time - from_ > time_tolerance_);
}

contact::Kinematics ContactEventLocator::current_kinematics() const {
  return system_.fleet().event_kinematics(change_.contact);
}

double ContactEventLocator::trial() {
  const double width = high_ - low_;
  const double margin = std::min(0.3 * time_tolerance_, 0.1 * width);
  trial_ = std::clamp(change_.time + (ends_before_ ? -margin : margin), low_ + margin, high_ - margin);
  return trial_;
}

double ContactEventLocator::end() const { return found_ ? end_ : nearest(); }

// The end just before or just after the change; the step must have a positive length.
double ContactEventLocator::nearest() const { return ends_before_ && low_ > from_ ? low_ : high_; }

void ContactEventLocator::end_at(double end) {
  found_ = true;
  end_ = end;
}

void ContactEventLocator::update(double at, const std::optional<train::Change>& change) {
  const double width = high_ - low_;
  if (change) {
    const bool other_contact = change->contact != change_.contact;
    const bool was_hidden = change_.hidden;
    high_ = at;
    change_ = *change;
    time_tolerance_ = system_.contacts().tolerance_of(change_.contact, tolerance_);
    high_kinematics_ = current_kinematics();
    if (other_contact) ends_before_ = ends_before();
    if (other_contact) low_ = system_.contacts().separations().time();
    if (other_contact) low_kinematics_ = system_.contacts().separations().kinematics(change_.contact);
    if (!ends_before_ && !change_.hidden && at - change_.time <= time_tolerance_) return end_at(at);
    // The penetration after an impact does not determine the time of the closing: the next trial bisects the interval.
    const bool converges_slowly = high_ - low_ > 0.5 * width;
    if (change_.gain && (converges_slowly || change_.hidden || was_hidden)) change_.time = 0.5 * (low_ + high_);
  } else {
    const bool shortened =
        at < trial_ - 0.1 * time_tolerance_;  // the stage equations had no solution for the whole trial step
    low_ = at;
    low_kinematics_ = current_kinematics();
    if (shortened) return end_at(at);
    if (!ends_before_) {
      if (change_.hidden) return end_at(full_end_);  // the shorter step does not confirm the opening
      change_.time = system_.contacts().separations().change_between(system_.fleet(), change_.contact, low_,
                                                                     low_kinematics_, high_, high_kinematics_);
    } else {
      const double rate = low_kinematics_.penetration_rate;
      const bool approaches = change_.gain ? rate > 0.0 : rate < 0.0;
      if (!approaches && change_.hidden && !change_.touched_in_stage) return end_at(full_end_);
      const double remaining = approaches ? -low_kinematics_.penetration / rate : 0.5 * (high_ - low_);
      if (approaches && remaining <= time_tolerance_) return end_at(at);
      change_.time = std::min(low_ + remaining, high_);
    }
  }
  if (high_ - low_ <= 0.1 * time_tolerance_) end_at(nearest());
}

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
  ContactEventLocator locator(system_, *change, from, full, settings_.contact_tolerance);
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
