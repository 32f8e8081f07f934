// Extremes (peaks) of a run. Between samples a curve is interpolated by a polynomial of degree four
// (extremum_tracker.hpp). The least and the greatest value at every probe form the envelopes along the bridge. When a
// wheel passes a probe, the moment there has a kink over time, and the shear jumps; option step_probes gives both an
// instant of their own. With damping b K both relax after that within a time of b, which may be much shorter than a
// step.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/load_movement.hpp"
#include "recovery/recovery.hpp"
#include "results/recorder.hpp"
#include "run/extremum_tracker.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// The quantities whose peaks are evaluated. `accuracy` controls the errors of those before `quantities`; the twist of
/// a track (m, recovery::track_base) is compared with limits only.
enum Quantity : std::size_t {
  deflection,
  acceleration,
  moment,
  wheel_force,
  low_passed,
  shear_force,
  axial_displacement,
  axial_force,
  quantities,
  twist_of_track = quantities,
  evaluated_quantities
};
inline constexpr std::array<const char*, quantities> quantity_names = {
    "deflection", "acceleration",       "moment",     "wheel force", "low-passed acceleration",
    "shear",      "axial displacement", "axial force"};
/// Their names in options and in the results file.
inline constexpr std::array<const char*, quantities> stored_names = {
    "deflection", "acceleration",       "moment",     "wheel_force", "acceleration_lowpass",
    "shear",      "axial_displacement", "axial_force"};

inline constexpr std::array<const char*, quantities> quantity_units = {"m", "m/s2", "N m", "N", "m/s2", "N", "m", "N"};

/// Whether only single runs by elements evaluate its peaks, not runs by modes or in batches.
inline constexpr bool by_elements_only(std::size_t q) { return q >= shear_force; }

/// The extremes of the section forces at a probe. A passage is the instant at which a load passes the probe. At a
/// passage the moment has a kink over time and the shear jumps (also the axial force, if the load has a component along
/// x, and the rate of the twist, if it is beside the shear centre); the values on both sides are extremes. They are
/// known if a step ends at the passage; otherwise they are extrapolated, where possible, by straight lines from the two
/// instants before and the two after it.
class ProbeForces {
 public:
  ProbeForces() = default;
  /// axial: the beam has an axial force; twists: it twists.
  ProbeForces(bool axial, bool twists) : has_{true, axial, twists} {}

  /// Calls record(Quantity, value, time, outward, other) for the extremes of moment, shear and axial force; other: the
  /// shear at a moment's extreme, the moment at a shear's extreme. passages: those since the previous instant,
  /// ascending; lag: b of Rayleigh damping, s, if the responses lag.
  template <class Record>
  void add(double t, const recovery::Response& r, std::span<const recovery::StationPassage> passages, double lag,
           Record&& record) {
    const bool lagging = lag > 0.0 && !std::isnan(r.moment_rate);
    for (const recovery::StationPassage& passage : passages) kinks_.add(passage.time);
    store({t, r.moment, jumping_of(r)});
    largest_moment_ = std::max(largest_moment_, std::abs(r.moment));
    if (lagging)
      lagging_moment_.add(t, r.moment, r.moment_rate, lag, of_moment(record));
    else
      moment_.add(t, r.moment, kinks_, of_moment(record));
    add_jumping(t, r, passages, lagging ? lag : 0.0, record);
  }
  template <class Record>
  void finish(double lag, Record&& record) {
    lagging_moment_.finish(of_moment(record));
    moment_.finish(kinks_, of_moment(record));
    finish_piece(lag, record);
  }

 private:
  static constexpr double same_instant =
      1e-4;  // relative to the time between two instants: a passage so near an instant with both sides belongs to it
  static constexpr double moment_tolerance = 0.02;  // relative to the largest moment at the probe
  static constexpr double hinge_arm = 1e-6;  // m: times the shear, a moment that is a rounding error, as at a hinge

  /// The quantities that jump at a passage.
  static constexpr std::array jumping = {shear_force, axial_force, twist_of_track};
  using Jumping = std::array<double, jumping.size()>;
  static Jumping jumping_of(const recovery::Response& r) { return {r.shear, r.axial_force, recovery::track_twist(r)}; }
  /// Their differences just before (side 0) or just after (1) a passage at this instant.
  static Jumping beside(const recovery::Response& r, std::size_t side) {
    return {r.shear_beside[side], r.axial_force_beside[side], recovery::track_base * r.twist_along_beside[side]};
  }

  struct Forces {
    double time = 0.0, moment = 0.0;
    Jumping jumping{};
    double shear() const { return jumping[0]; }
    /// Linear interpolation or extrapolation with these forces and the forces at another instant.
    Forces at(double t, const Forces& through) const {
      const double part = (t - time) / (through.time - time);
      Forces there{t, moment + part * (through.moment - moment), jumping};
      for (std::size_t k = 0; k < jumping.size(); ++k) there.jumping[k] += part * (through.jumping[k] - jumping[k]);
      return there;
    }
  };

  template <class Record>
  auto of_moment(Record& record) {
    return [this, &record](double value, double at, bool outward) {
      record(moment, value, at, outward, interpolate(at).shear());
    };
  }
  template <class Record>
  auto of_jumping(std::size_t k, Record& record) {
    return [this, k, &record](double value, double at, bool outward) {
      record(jumping[k], value, at, outward, jumping[k] == shear_force ? interpolate(at).moment : 0.0);
    };
  }
  /// The twist is known without lag.
  static double lag_of(std::size_t k, double lag) { return jumping[k] == twist_of_track ? 0.0 : lag; }

  /// Whether a straight line through two instants `apart` s apart may be continued for `beyond` s: through two instants
  /// close together, at an event, it has the slope of rounding errors.
  static bool reaches(double beyond, double apart) { return beyond <= base::Stencil::most_uneven * apart; }

  template <class Record>
  void add_jumping(double t, const recovery::Response& r, std::span<const recovery::StationPassage> passages,
                   double lag, Record&& record) {
    if (instants_ > 0 && t <= latest_[0].time) return;  // this instant was already added
    Forces relaxed = {t, r.moment, jumping_of(r)};
    if (lag > 0.0) relaxed.jumping[0] -= r.unrelaxed_shear;
    if (lag > 0.0) relaxed.jumping[1] -= r.unrelaxed_axial_force;
    const bool ends_there = beside(r, 0) != Jumping{} || beside(r, 1) != Jumping{};
    const double tolerance = instants_ > 0 ? same_instant * (t - latest_[0].time) : 0.0;
    std::size_t between = 0;
    double passage = 0.0;
    for (const recovery::StationPassage& p : passages) {
      if ((ended_there_ && p.time <= latest_[0].time + tolerance) || (ends_there && p.time >= t - tolerance)) continue;
      passage = p.time;
      ++between;
    }
    ended_there_ = ends_there;
    if (ends_there) {
      const auto side_forces = [&](std::size_t side) {
        Forces forces = relaxed;
        for (std::size_t k = 0; k < jumping.size(); ++k) forces.jumping[k] += beside(r, side)[k];
        return forces;
      };
      if (between == 0) add_to_piece(side_forces(0), r, lag, record);
      finish_piece(lag, record);
      kinks_.add(t);
      add_to_piece(side_forces(1), r, lag, record);
    } else if (between > 0) {
      const bool known =
          between == 1 && instants_ > 1 && reaches(passage - latest_[0].time, latest_[0].time - latest_[1].time);
      if (known) before_passage_ = latest_[0].at(passage, latest_[1]);
      finish_piece(lag, record);
      has_before_ = known;
      add_to_piece(relaxed, r, lag, record);
    } else {
      add_to_piece(relaxed, r, lag, record);
    }
  }
  /// Adds an instant on one side of all passages of loads to the present interval between passages, or to a new one.
  template <class Record>
  void add_to_piece(const Forces& now, const recovery::Response& r, double lag, Record& record) {
    if (has_before_ && instants_ == 1 && reaches(latest_[0].time - before_passage_.time, now.time - latest_[0].time))
      record_sides(latest_[0].at(before_passage_.time, now), now, lag, record);
    const Jumping all = jumping_of(r);
    for (std::size_t k = 0; k < jumping.size(); ++k)
      if (has_[k])
        curves_[k].add(now.time, now.jumping[k], all[k] - now.jumping[k], lag_of(k, lag), of_jumping(k, record));
    latest_ = {now, latest_[0]};
    ++instants_;
  }
  template <class Record>
  void finish_piece(double lag, Record& record) {
    for (std::size_t k = 0; k < jumping.size(); ++k)
      if (instants_ > 0 && has_[k]) curves_[k].finish(lag_of(k, lag), of_jumping(k, record));
    instants_ = 0;
    has_before_ = false;
  }
  // If the extrapolated moments of both sides differ, although the moment does not jump, the instants are too far apart
  // for straight lines.
  template <class Record>
  void record_sides(const Forces& after_passage, const Forces& now, double lag, Record& record) {
    has_before_ = false;
    const double allowed = moment_tolerance * largest_moment_ + hinge_arm * std::abs(after_passage.shear());
    if (std::abs(after_passage.moment - before_passage_.moment) > allowed) return;
    const bool lower = std::abs(before_passage_.moment) < std::abs(after_passage.moment);
    record(moment, lower ? before_passage_.moment : after_passage.moment, before_passage_.time, true,
           lower ? before_passage_.shear() : after_passage.shear());
    for (std::size_t k = 0; k < jumping.size(); ++k) {
      if (!has_[k]) continue;
      const double first = before_passage_.jumping[k], second = after_passage.jumping[k],
                   duration = now.time - after_passage.time,
                   other = jumping[k] == shear_force ? after_passage.moment : 0.0;
      const JumpExtremum after =
          extremum_after_jump(first, second, (now.jumping[k] - second) / duration, lag_of(k, lag));
      record(jumping[k], first, before_passage_.time, true, other);
      if (after.exists && after.later < duration)  // the line reaches no further
        record(jumping[k], after.value, after_passage.time + after.later, true, other);
    }
  }

  void store(const Forces& now) {
    history_[next_] = now;
    next_ = (next_ + 1) % history_.size();
    if (count_ < history_.size()) ++count_;
  }
  /// Linear interpolation between the instants around t, which is one of the latest.
  Forces interpolate(double t) const {
    const auto latest = [&](std::size_t i) -> const Forces& {
      return history_[(next_ + 2 * history_.size() - 1 - i) % history_.size()];
    };
    for (std::size_t i = 0; i + 1 < count_; ++i)
      if (latest(i + 1).time < t && latest(i).time > latest(i + 1).time && t <= latest(i).time)
        return latest(i).at(t, latest(i + 1));
    return latest(count_ - 1 < 1 || t >= latest(0).time ? 0 : count_ - 1);
  }

  ExtremumTracker moment_;
  KinkTimes kinks_;  // of the moment
  LaggedMomentTracker lagging_moment_;
  std::array<bool, jumping.size()> has_{true};
  std::array<JumpingCurve, jumping.size()> curves_;
  std::array<Forces, 2> latest_{};  // relaxed forces in the interval between two passages, the latest first
  std::size_t instants_ = 0;        // in this interval between passages
  bool ended_there_ = false;        // the latest instant has both sides
  bool has_before_ = false;
  Forces before_passage_;  // forces just before a passage between two instants; the forces after it are not yet known
  std::array<Forces, 8> history_{};
  std::size_t next_ = 0, count_ = 0;
  double largest_moment_ = 0.0;  // N m
};

/// The least and the greatest value of one quantity at one probe, with their times.
struct Range {
  struct End {
    double value = 0.0, time = std::numeric_limits<double>::quiet_NaN();
    double other = 0.0;  // for a moment the shear at the same time, for a shear the moment
  };
  End least, greatest;
};

/// The signed extremes of a run above half of the largest one so far. Places are probes or wheels. Deflections are
/// relative to the line through the supports.
class ResponseExtremes {
 public:
  ResponseExtremes() = default;
  /// lag: lag of the moments, b of Rayleigh damping in s, if responses have rates; axial: the beam has axial
  /// displacements; twists: it twists.
  ResponseExtremes(std::size_t probes, std::size_t wheels, double lag = 0.0, bool axial = false, bool twists = false);

  /// The values of places, of which only `which` (ascending) have changed since the previous instant.
  template <class Value>
  struct Values {
    std::span<const Value> of_all;
    std::span<const std::size_t> which;
  };
  /// passages: of probes since the previous instant, as of LoadMovement.
  void add(double t, Values<recovery::Response> probes, Values<double> wheel_forces,
           std::span<const recovery::StationPassage> passages = {});
  void finish();
  /// Adds the extremes of low-passed accelerations, rows of all probes at intervals of `interval` s from 0 on.
  void add_low_passed(std::span<const double> rows, double interval);
  /// The empty object of a failed run.
  static ResponseExtremes of_failure();
  bool failed() const { return failed_; }

  const std::vector<Extreme>& of(Quantity q) const { return peaks_[q]; }
  const Extreme& largest(Quantity q) const { return largest_[q]; }
  /// The largest extreme of each probe or wheel.
  const std::vector<Extreme>& largest_of_each(Quantity q) const { return largest_of_each_[q]; }
  /// The range of a probe's deflection, acceleration, moment or shear.
  const Range& range(Quantity q, std::size_t probe) const { return ranges_[probe][q]; }
  std::size_t probes() const { return ranges_.size(); }
  void keep(base::Bytes& bytes) { bytes(forces_, motions_, wheels_, peaks_, largest_, largest_of_each_, ranges_); }

 private:
  /// The motions whose extremes are tracked for each probe.
  static constexpr std::array motions = {deflection, acceleration, axial_displacement};
  void record_peak(Quantity q, std::size_t place, double value, double time);
  auto recorder_of(Quantity q, std::size_t probe);
  auto recorder_of_forces(std::size_t probe);
  void record_range(Quantity q, std::size_t probe, double value, double time, double other);

  double lag_ = 0.0;
  bool axial_ = false;
  std::vector<ProbeForces> forces_;
  std::vector<std::array<ExtremumTracker, motions.size()>> motions_;
  std::vector<ExtremumTracker> wheels_;
  std::vector<std::array<Range, evaluated_quantities>> ranges_;
  std::array<std::vector<Extreme>, evaluated_quantities> peaks_;
  std::array<Extreme, evaluated_quantities> largest_{};
  bool failed_ = false;
  std::array<std::vector<Extreme>, evaluated_quantities> largest_of_each_;
};

/// The least magnitude of the sample next to the largest extreme of a series, relative to its largest sample.
inline constexpr double share_of_largest_sample = 0.8;
/// The extreme with the largest magnitude of several series, rows of `series` values at intervals of `interval` s from
/// first * interval on; place: index of the series.
Extreme largest_peak(std::span<const double> rows, std::size_t series, double interval, std::size_t first = 0);

/// The relative difference of the largest extremes of two runs, or, if larger, twice the root mean square of the
/// differences of all extremes above 0.6 of the largest one that are nearest to each other in both runs, within
/// max_shift s, because the two largest ones may agree by chance. Wheel forces are compared by their variation about
/// the weight. 0 without extremes, 1 if a run failed.
double difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q, double max_shift);

/// The relative difference of the largest extremes only.
double peak_difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q);

/// The empty extremes of a run of the scene. lag: b of Rayleigh damping if responses have rates, s.
ResponseExtremes peaks_for(const scene::Scene& scene, std::size_t wheels, double lag);

/// /envelope/deflection, acceleration, moment, shear, each [p,2]: least and greatest, interpolated between samples;
/// each with _time (s). moment_shear and shear_moment: the shear, and the moment, at these instants. forces: whether
/// moments and shears are known.
std::vector<results::Recorder::Dataset> envelopes(const ResponseExtremes& peaks, bool forces);

}  // namespace traverse::run
