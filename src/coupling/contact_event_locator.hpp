// Locates the end of a step in which a contact opens or closes: just after an opening, just before a closing. A guided
// wheel leaves the beam while its force acts: a step ends just before that, and a very short one just after it.
#pragma once

#include <optional>

#include "coupling/system.hpp"

namespace traverse::coupling {

class ContactEventLocator {
 public:
  /// `change` occurs between `from`, the last accepted instant, and `to`, the time that the vehicles are set to.
  ContactEventLocator(const System& system, const train::Change& change, double from, double to, double tolerance);

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

  const System& system_;
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

}  // namespace traverse::coupling
