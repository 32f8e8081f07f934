// Narrows the interval that contains a change of contact by trial steps: the next trial time is interpolated from
// penetration and penetration rate, and bisection replaces it where it converges slowly.
#include "coupling/contact_event_locator.hpp"

#include <algorithm>

namespace traverse::coupling {

ContactEventLocator::ContactEventLocator(const System& system, const train::Change& change, double from, double to,
                                         double tolerance)
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

}  // namespace traverse::coupling
