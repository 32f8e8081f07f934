// When contacts part and meet again: the changes of a step, found between its ends by the cubic through penetrations
// and their rates, and the list of all separations.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "train/fleet.hpp"

namespace traverse::train {

/// From the loss of a contact to the impact that ends it.
struct Separation {
  int contact = 0;              // as Fleet::contact counts
  bool from_start = false;      // apart since t = 0: no loss
  double x = 0.0;               // m, of the body where it parts
  double start = 0.0;           // s
  double duration = -1.0;       // s; below 0: still apart at the end of the run
  double approach_speed = 0.0;  // m/s, where it meets again
  double impact_force = 0.0;    // N, the greatest of the compression that follows
};

/// A contact lost or gained between two instants.
struct Change {
  int contact;
  double time;  // s, as the cubic has it
  bool gain;    // surfaces meet: not those that a damper grips again before they have parted
  bool hidden;  // parts and meets again, or the other way round, between the two instants
  bool seen;    // a gain that a stage of the step met
};

class Separations {
 public:
  /// The contacts as they are at an accepted instant; those apart at the first one are apart from the start.
  void accept(const Fleet& fleet, double t);

  /// The first change between the last accepted instant and the fleet as it is now at t, but for gains that `left_out`
  /// names by their contact.
  std::optional<Change> change(const Fleet& fleet, double t, const std::function<bool(int)>& left_out) const;
  /// When a contact changes that is seen as `low` at t_low and as `high` at t_high.
  double change_between(const Fleet& fleet, int contact, double t_low, const contact::Kinematics& low, double t_high,
                        const contact::Kinematics& high) const;
  /// The gap at the last accepted instant over the speed of approach; infinite where they touch or recede, s.
  double time_to_touch(int contact) const;
  double time() const { return time_; }
  const contact::Kinematics& kinematics(int contact) const { return seen_[contact].kinematics; }
  /// Whether a contact, apart before the last accepted instant, was found touching at it.
  bool met(int contact) const { return seen_[contact].met; }
  bool touching(int contact) const { return seen_[contact].touching; }

  const std::vector<Separation>& list() const { return list_; }
  void keep(base::Bytes& bytes) { bytes(time_, seen_, list_); }

 private:
  struct Seen {
    bool touching = false;
    bool met = false;
    contact::Kinematics kinematics;
    int open = -1;           // entry of the list: apart since
    int compressed_by = -1;  // entry of the list: the impact whose compression goes on
  };
  void record_impact(const Fleet& fleet, int contact, double t, Seen& seen);

  double time_ = 0.0;
  std::vector<Seen> seen_;
  std::vector<Separation> list_;
};

}  // namespace traverse::train
