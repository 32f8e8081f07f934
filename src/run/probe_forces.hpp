// The extremes of the section forces at a probe. Where a load passes it the moment has a kink and the shear jumps (and
// the axial force, where the load pushes along x): the values on both sides count. They are known where a step ends at
// the passage; else they follow, where these serve, from the two instants before and the two behind by straight lines.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "recovery/recovery.hpp"
#include "run/extremum_tracker.hpp"
#include "run/quantity.hpp"

namespace traverse::app {

class ProbeForces {
 public:
  ProbeForces() = default;
  /// axial: the beam has an axial force; passages_known: what passes the probe, and when, is known beforehand.
  ProbeForces(bool axial, bool passages_known)
      : shear_(!passages_known), axial_(!passages_known), has_axial_(axial), known_(passages_known) {}

  /// Calls note(Quantity, value, time, outward, other) for the extremes of moment, shear and axial force, where other
  /// is the shear that belongs to a moment and the moment that belongs to a shear. passages: times at which something
  /// passes, s, ascending; lag: b of Rayleigh damping, s, where the responses lag.
  template <class Note>
  void add(double t, const beam::Response& r, const std::vector<double>& passages, double lag, Note&& note) {
    const bool relaxes = lag > 0.0 && !std::isnan(r.moment_rate);
    remember({t, r.moment, r.shear, r.axial_force});
    largest_moment_ = std::max(largest_moment_, std::abs(r.moment));
    if (relaxes)
      lagging_.add(t, r.moment, r.moment_rate, lag, of_moment(note));
    else
      moment_.add(t, r.moment, passages, of_moment(note));
    add_jumping(t, r, passages, relaxes ? lag : 0.0, note);
  }
  template <class Note>
  void finish(const std::vector<double>& passages, double lag, Note&& note) {
    lagging_.finish(of_moment(note));
    moment_.finish(passages, of_moment(note));
    finish_piece(lag, note);
  }

 private:
  static constexpr double at_passage = 1e-6;   // of the time between two instants: which side one is on is not known
  static constexpr double just_after = 1e-4;   // of it: so far from the instant at which it ends a passage may be
  static constexpr double same_moment = 0.02;  // of the largest one there
  static constexpr double hinged = 1e-6;       // m: times the shear, a moment that is rounding, as at a hinge

  struct Forces {
    double time = 0.0, moment = 0.0, shear = 0.0, axial = 0.0;
    /// By a straight line through this one and another.
    Forces at(double t, const Forces& through) const {
      const double part = (t - time) / (through.time - time);
      return {t, moment + part * (through.moment - moment), shear + part * (through.shear - shear),
              axial + part * (through.axial - axial)};
    }
  };

  template <class Note>
  auto of_moment(Note& note) {
    return
        [this, &note](double value, double at, bool outward) { note(moment, value, at, outward, seen_at(at).shear); };
  }
  template <class Note>
  auto of_shear(Note& note) {
    return [this, &note](double value, double at, bool outward) {
      note(shear_force, value, at, outward, seen_at(at).moment);
    };
  }
  template <class Note>
  static auto of_axial(Note& note) {
    return [&note](double value, double at, bool outward) { note(axial_force, value, at, outward, 0.0); };
  }

  template <class Note>
  void add_jumping(double t, const beam::Response& r, const std::vector<double>& passages, double lag, Note&& note) {
    if (instants_ > 0 && t <= latest_[0].time) return;  // the same instant, seen twice
    const bool rests = known_ && lag > 0.0;
    const Forces relaxed = {t, r.moment, r.shear - (rests ? r.unrelaxed_shear : 0.0),
                            r.axial_force - (rests ? r.unrelaxed_axial_force : 0.0)};
    const bool ends_there = (known_ || lag == 0.0) && (r.shear_beside != none || r.axial_force_beside != none);
    const double since = instants_ > 0 ? t - latest_[0].time : 0.0;
    const std::size_t first = passed_;
    while (passed_ < passages.size() && passages[passed_] <= t + (ends_there ? just_after * since : 0.0)) ++passed_;
    const std::size_t passages_now = passed_ - first;
    if (ends_there) {
      const auto beside = [&](std::size_t side) {
        return Forces{t, relaxed.moment, relaxed.shear + r.shear_beside[side],
                      relaxed.axial + r.axial_force_beside[side]};
      };
      if (passages_now <= 1) go_on(beside(0), r, lag, note);
      finish_piece(lag, note);
      go_on(beside(1), r, lag, note);
    } else if (passages_now > 0) {
      const double passage = passages[passed_ - 1];
      const bool known = passages_now == 1 && instants_ > 1;
      if (known) ahead_ = latest_[0].at(passage, latest_[1]);
      finish_piece(lag, note);
      has_ahead_ = known;
      if (t - passage > at_passage * since) go_on(relaxed, r, lag, note);
    } else {
      go_on(relaxed, r, lag, note);
    }
  }
  /// An instant on one side of all passages, of the piece that has begun or of the next one.
  template <class Note>
  void go_on(const Forces& now, const beam::Response& r, double lag, Note& note) {
    if (has_ahead_ && instants_ == 1) record_sides(latest_[0].at(ahead_.time, now), now, lag, note);
    shear_.add(now.time, now.shear, r.shear - now.shear, lag, of_shear(note));
    if (has_axial_) axial_.add(now.time, now.axial, r.axial_force - now.axial, lag, of_axial(note));
    latest_ = {now, latest_[0]};
    ++instants_;
  }
  template <class Note>
  void finish_piece(double lag, Note& note) {
    if (instants_ > 0) shear_.finish(lag, of_shear(note));
    if (instants_ > 0 && has_axial_) axial_.finish(lag, of_axial(note));
    instants_ = 0;
    has_ahead_ = false;
  }
  // Where the moment, which does not jump, is not the same from both sides, instants are too far apart for straight
  // lines.
  template <class Note>
  void record_sides(const Forces& behind, const Forces& now, double lag, Note& note) {
    has_ahead_ = false;
    const double allowed = same_moment * largest_moment_ + hinged * std::abs(behind.shear);
    if (std::abs(behind.moment - ahead_.moment) > allowed) return;
    const bool lower = std::abs(ahead_.moment) < std::abs(behind.moment);
    note(moment, lower ? ahead_.moment : behind.moment, ahead_.time, true, lower ? ahead_.shear : behind.shear);
    const auto both = [&](Quantity q, double Forces::*force, double other) {
      const JumpTurn after =
          turn_after_jump(ahead_.*force, behind.*force, (now.*force - behind.*force) / (now.time - behind.time), lag);
      note(q, ahead_.*force, ahead_.time, true, other);
      if (after.there) note(q, after.value, behind.time + after.later, true, other);
    };
    both(shear_force, &Forces::shear, behind.moment);
    if (has_axial_) both(axial_force, &Forces::axial, 0.0);
  }

  void remember(const Forces& now) {
    seen_[next_] = now;
    next_ = (next_ + 1) % seen_.size();
    if (count_ < seen_.size()) ++count_;
  }
  /// By a straight line between the instants around t, which is one of the latest ones.
  Forces seen_at(double t) const {
    const auto back = [&](std::size_t i) -> const Forces& {
      return seen_[(next_ + 2 * seen_.size() - 1 - i) % seen_.size()];
    };
    for (std::size_t i = 0; i + 1 < count_; ++i)
      if (back(i + 1).time < t && back(i).time > back(i + 1).time && t <= back(i).time)
        return back(i).at(t, back(i + 1));
    return back(count_ - 1 < 1 || t >= back(0).time ? 0 : count_ - 1);
  }

  static constexpr std::array<double, 2> none{};
  ExtremumTracker moment_;
  LaggedMomentTracker lagging_;
  JumpingCurve shear_, axial_;
  std::array<Forces, 2> latest_{};         // of the piece between two passages, relaxed, the last one first
  std::size_t instants_ = 0, passed_ = 0;  // in this piece; of the passages
  bool has_ahead_ = false;
  Forces ahead_;  // of a passage between two instants: as it comes; what is behind it is not known yet
  std::array<Forces, 8> seen_{};
  std::size_t next_ = 0, count_ = 0;
  double largest_moment_ = 0.0;  // N m
  bool has_axial_ = false, known_ = true;
};

}  // namespace traverse::app
