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
      full_(to),
      low_(from),
      high_(to),
      below_(system.contacts().separations().kinematics(change.contact)),
      above_(now()),
      tolerance_(tolerance),
      wanted_(system.contacts().tolerance_of(change.contact, tolerance)),
      end_(to) {
  if (!change.gain && !change.hidden && to - change.time <= wanted_) found_ = true;
}

const contact::Kinematics& ContactEventLocator::now() const { return system_.fleet().kinematics(change_.contact); }

double ContactEventLocator::trial() {
  const double width = high_ - low_;
  const double margin = std::min(0.3 * wanted_, 0.1 * width);
  trial_ = std::clamp(change_.time + (change_.gain ? -margin : margin), low_ + margin, high_ - margin);
  return trial_;
}

double ContactEventLocator::end() const { return found_ ? end_ : nearest(); }

// Just before a gain, just behind a loss; but a step has some length.
double ContactEventLocator::nearest() const { return change_.gain && low_ > from_ ? low_ : high_; }

void ContactEventLocator::end_at(double end) {
  found_ = true;
  end_ = end;
}

void ContactEventLocator::tried(double at, const std::optional<train::Change>& change) {
  const double width = high_ - low_;
  if (change) {
    const bool other = change->contact != change_.contact;
    const bool was_hidden = change_.hidden;
    high_ = at;
    change_ = *change;
    wanted_ = system_.contacts().tolerance_of(change_.contact, tolerance_);
    above_ = now();
    if (other) low_ = system_.contacts().separations().time();
    if (other) below_ = system_.contacts().separations().kinematics(change_.contact);
    if (!change_.gain && !change_.hidden && at - change_.time <= wanted_) return end_at(at);
    // a gain met in a step that was not short enough: what comes after the impact says little of when it was
    const bool slow = high_ - low_ > 0.5 * width;
    if (change_.gain && (slow || change_.hidden || was_hidden)) change_.time = 0.5 * (low_ + high_);
  } else {
    const bool cut = at < trial_ - 0.1 * wanted_;  // it could not be taken that far
    low_ = at;
    below_ = now();
    if (cut) return end_at(at);
    if (!change_.gain) {
      if (change_.hidden) return end_at(full_);  // it only seemed so
      change_.time = system_.contacts().separations().change_between(system_.fleet(), change_.contact, low_, below_,
                                                                     high_, above_);
    } else {
      const bool approaches = below_.penetration_rate > 0.0;
      if (!approaches && change_.hidden && !change_.seen) return end_at(full_);
      const double left = approaches ? -below_.penetration / below_.penetration_rate : 0.5 * (high_ - low_);
      if (approaches && left <= wanted_) return end_at(at);
      change_.time = std::min(low_ + left, high_);
    }
  }
  if (high_ - low_ <= 0.1 * wanted_) end_at(nearest());
}

}  // namespace traverse::coupling
