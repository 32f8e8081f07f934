// Openings and closings of contacts: the changes in a step, located by the cubic through penetrations and their rates,
// and the list of all separations.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "train/fleet.hpp"

namespace traverse::train {

/// A separation: from the opening of a contact to the impact that ends it.
struct Separation {
  int contact = 0;              // index of Fleet::contact
  bool from_start = false;      // open since t = 0, without an opening
  double x = 0.0;               // position of the body at the opening, m
  double start = 0.0;           // s
  double duration = -1.0;       // s; negative: open at the end of the run
  double approach_speed = 0.0;  // m/s, at the closing
  double impact_force = 0.0;    // N, greatest force of the following compression
};

/// An opening or closing of a contact between two instants.
struct Change {
  int contact;
  double time;            // s, by the cubic
  bool gain;              // a closing, except after an opening by a damper before the surfaces separated
  bool hidden;            // the contact opens and closes, or closes and opens, between the two instants
  bool touched_in_stage;  // a closing with a contact force in a stage of the step
};

class Separations {
 public:
  /// Records the contacts at an accepted instant; contacts that are open at the first one are open from the start.
  void accept(const Fleet& fleet, double t);

  /// The first change between the last accepted instant and the fleet's present state at t, without closings for which
  /// `excluded` returns true.
  std::optional<Change> change(const Fleet& fleet, double t, const std::function<bool(int)>& excluded) const;
  /// The time at which a contact changes between the state `low` at t_low and the state `high` at t_high.
  double change_between(const Fleet& fleet, int contact, double t_low, const contact::Kinematics& low, double t_high,
                        const contact::Kinematics& high) const;
  /// The gap at the last accepted instant over the approach speed, s; infinite for a closed or receding contact.
  double time_to_touch(int contact) const;
  double time() const { return time_; }
  const contact::Kinematics& kinematics(int contact) const { return states_[contact].kinematics; }
  /// Whether a contact, open before the last accepted instant, was closed at it.
  bool just_closed(int contact) const { return states_[contact].just_closed; }
  bool touching(int contact) const { return states_[contact].touching; }

  const std::vector<Separation>& list() const { return list_; }
  void keep(base::Bytes& bytes) { bytes(time_, states_, list_); }

 private:
  struct ContactState {
    bool touching = false;
    bool just_closed = false;
    contact::Kinematics kinematics;
    int open = -1;           // index of the present separation in the list
    int compressed_by = -1;  // index of the separation whose impact is in compression
  };
  void record_impact(const Fleet& fleet, int contact, double t, ContactState& state);

  double time_ = 0.0;
  std::vector<ContactState> states_;
  std::vector<Separation> list_;
};

}  // namespace traverse::train
