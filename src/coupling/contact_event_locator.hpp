// The search for the end of a step in which a contact is lost or gained: just behind a loss, just before a gain.
#pragma once

#include <optional>

#include "coupling/system.hpp"

namespace traverse::coupling {

class ContactEventLocator {
 public:
  /// `change` happens between `from`, the last accepted instant, and `to`, where the vehicles of the system are now.
  ContactEventLocator(const System& system, const train::Change& change, double from, double to, double tolerance);

  bool found() const { return found_; }
  /// Where the step should end next.
  double trial();
  /// The step was taken to `at`, where the vehicles are now, with this change in it.
  void tried(double at, const std::optional<train::Change>& change);
  /// When found, or given up: where the step has to end.
  double end() const;

 private:
  const contact::Kinematics& now() const;
  double nearest() const;
  void end_at(double end);

  const System& system_;
  train::Change change_;
  double from_, full_;                 // the whole step, its end
  double low_, high_;                  // no change before, a change before
  contact::Kinematics below_, above_;  // of its contact there
  double tolerance_;
  double wanted_;  // of both, s
  bool found_ = false;
  double trial_ = 0.0;
  double end_;
};

}  // namespace traverse::coupling
