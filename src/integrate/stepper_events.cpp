// Steps that end at events which the motion itself decides on: contacts lost and gained, wheels that turn about
// corners.
#include <cmath>

#include "arrays.hpp"
#include "integrate/stepper.hpp"

namespace traverse::integrate {
namespace {

using base::check;

constexpr int most_trials = 40;      // of a step's end at the change of a contact
constexpr int most_turn_trials = 3;  // and where a wheel turns about a corner

}  // namespace

// When the next wheel turns about a corner of the surface, if it does so within `left` s. A multistep method is started
// anew by a short step, which costs it more; the ladder sees the corner's error, and keeps to the steps it has factors
// of.
std::optional<coupling::KinkEvents::KinkPassage> Stepper::next_kink(double from, double left) {
  if (!settings_.corners || multistep_ || ladder_) return std::nullopt;
  ReadArray y(y_);
  return system_.next_kink(from, left, y.data);
}

// Sets the vehicles to where the step has led.
void Stepper::arrive(double t) {
  ReadArray y(y_);
  system_.arrive(t, y.data);
}

// Takes the step from `from` again, to another end. Returns the time reached.
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
  arrive(reached);
  return reached;
}

// Takes the step from `from` again, shorter, where a contact is lost or gained in it: until it ends just behind the
// first loss, or just before the first gain, since a stiff contact must not be met in a long step. `full`: where it
// ended at first. Returns the time reached.
double Stepper::locate_contact_change(double from, double full) {
  arrive(full);
  auto change = system_.contacts().change(full, settings_.contact_tolerance);
  if (!change) return full;
  coupling::ContactEventLocator bracket(system_, *change, from, full, settings_.contact_tolerance);
  double at = full;
  for (int i = 0; i < most_trials && !bracket.found(); ++i) {
    at = step_again(from, bracket.trial());
    bracket.tried(at, system_.contacts().change(at, settings_.contact_tolerance));
  }
  return at != bracket.end() ? step_again(from, bracket.end()) : at;
}

// Takes the step from `from` to `at` again where the wheel turns about its corner at another time than was expected.
double Stepper::end_at_kink(double from, double at, const coupling::KinkEvents::KinkPassage& turn) {
  arrive(at);
  for (int i = 0; i < most_turn_trials; ++i) {
    double found = 0.0;
    {
      ReadArray y(y_);
      found = system_.time_of(turn, at, y.data);
    }
    if (!(std::abs(found - at) > turn.tolerance) || !(found > from) || !std::isfinite(found)) break;
    at = step_again(from, found);
  }
  return at;
}

}  // namespace traverse::integrate
