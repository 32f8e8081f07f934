// The extremes of sampled curves. Between samples a curve is of fourth degree (turn.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "base/bytes.hpp"
#include "run/turn.hpp"

namespace traverse::app {

inline bool between(const std::vector<double>& times, double from, double to) {
  const auto next = std::lower_bound(times.begin(), times.end(), from);
  return next != times.end() && *next <= to;
}

/// The extremes of one curve, as samples come. Each is given to note(value, time, outward), where outward tells whether
/// its magnitude is extreme too: it is the greatest above zero or the least below.
class ExtremumTracker {
 public:
  ExtremumTracker() = default;
  /// of_samples: nothing is known of it between its samples, where it may jump.
  explicit ExtremumTracker(bool of_samples) : of_samples_(of_samples) {}

  /// Calls note for the extreme that is known with this sample, two after it. kinks: ascending times at which the curve
  /// may have one.
  template <class Note>
  void add(double t, double value, const std::vector<double>& kinks, Note&& note) {
    const double latest = seen_.time[4];
    if (seen_.count > 1 && t - latest < too_near * (latest - seen_.time[3])) {
      if (std::abs(value) > std::abs(seen_.value[4])) std::tie(seen_.time[4], seen_.value[4]) = std::tie(t, value);
      return;
    }
    seen_.push(t, value);
    if (seen_.count == 1) return note(value, t, true);
    if (seen_.count >= 4) look(2, kinks, note);
  }
  /// After the last sample: the extreme just before it.
  template <class Note>
  void rest(const std::vector<double>& kinks, Note&& note) const {
    if (seen_.count >= 3) look(3, kinks, note);
  }
  /// That, and its value counts too.
  template <class Note>
  void finish(const std::vector<double>& kinks, Note&& note) const {
    rest(kinks, note);
    if (seen_.count > 0) note(seen_.value.back(), seen_.time.back(), true);
  }
  /// Forgets its samples.
  void begin_anew() { seen_ = {}; }
  /// How far the latest three samples are from a straight line: their second difference, 0 where they are fewer.
  double bend() const {
    const auto &t = seen_.time, &y = seen_.value;
    const double before = t[3] - t[2], after = t[4] - t[3];
    if (seen_.count < 3 || !(before > 0.0 && after > 0.0)) return 0.0;
    return std::abs((y[4] - y[3]) / after - (y[3] - y[2]) / before) * std::min(before, after);
  }

 private:
  // Of the step before: the slope between instants that are nearer than that is made by rounding, and a parabola
  // through them overshoots.
  static constexpr double too_near = 1e-2;

  /// If the sample at i is extreme.
  template <class Note>
  void look(std::size_t i, const std::vector<double>& kinks, Note&& note) const {
    const auto &t = seen_.time, &y = seen_.value;
    const bool outward = std::abs(y[i]) >= std::abs(y[i - 1]) && std::abs(y[i]) > std::abs(y[i + 1]);
    if (!outward && !((y[i] - y[i - 1]) * (y[i + 1] - y[i]) < 0.0)) return;
    const Extreme turn = turn_about(seen_, i, [&](std::size_t from, std::size_t to) {
      return !of_samples_ && y[from] * y[to] > 0.0 && !between(kinks, t[from], t[to]);
    });
    note(turn.value, turn.time, outward);
  }

  Samples seen_;
  bool of_samples_ = false;
};

/// The extremes of a curve M that follows a smooth one by M + b dM/dt, but for its kinks, which have samples.
class LaggedMomentTracker {
 public:
  /// b in s.
  template <class Note>
  void add(double t, double value, double rate, double b, Note&& note) {
    const double h = t - time_, before = rate_, start = value_;
    if (!known_) note(value, t, true);
    if (known_ && h > 0.0 && before * rate < 0.0) {
      double later = 0.0;
      const double top = base::extreme_of_lagging(h, start, value, before, rate, b, later);
      note(top, time_ + later, before * start > 0.0);
    }
    time_ = t;
    value_ = value;
    rate_ = rate;
    known_ = true;
  }
  template <class Note>
  void finish(Note&& note) const {
    if (known_) note(value_, time_, true);
  }

 private:
  double time_ = 0.0, value_ = 0.0, rate_ = 0.0;  // the latest sample
  bool known_ = false;
};

/// The extreme behind a jump of S from one value to another, of V = S + (before - after) exp(-t/b) where S goes on with
/// that slope; b = 0: S itself.
struct JumpTurn {
  bool there = false;
  double value = 0.0, later = 0.0;  // s after the jump
};
inline JumpTurn turn_after_jump(double before, double after, double slope, double b) {
  if (b == 0.0) return {true, after, 0.0};
  const double way = b * std::log((before - after) / (b * slope));
  return {way > 0.0 && std::isfinite(way), after + slope * (way + b), way};
}

/// The extremes of a curve that jumps where loads pass, in pieces between passages: the shear, or the axial force. With
/// damping b K it relaxes behind a jump, V = S + r exp(-t/b), where S is smooth.
class JumpingCurve {
 public:
  JumpingCurve() = default;
  /// of_samples: nobody knows when it jumps.
  explicit JumpingCurve(bool of_samples) : smooth_(of_samples) {}

  /// relaxed: S; unrelaxed: what is left of r, which is looked at where a piece begins. b in s, 0: the curve is S.
  template <class Note>
  void add(double t, double relaxed, double unrelaxed, double b, Note&& note) {
    if (!known_) {
      begin_ = t;
      rest_ = b > 0.0 ? unrelaxed : 0.0;
    } else if (const double rest = rest_at(time_, b); std::abs(rest) > little * std::abs(relaxed)) {
      const double slope = (relaxed - relaxed_) / (t - time_);
      const JumpTurn turn = turn_after_jump(relaxed_ + rest, relaxed_, slope, b);
      if (turn.there && turn.later < t - time_) note(turn.value, time_ + turn.later, slope * turn.value < 0.0);
    }
    time_ = t;
    relaxed_ = relaxed;
    known_ = true;
    smooth_.add(t, relaxed, {}, with_rest(b, note));
  }
  /// After the last sample of a piece; the next one begins anew.
  template <class Note>
  void finish(double b, Note&& note) {
    smooth_.finish({}, with_rest(b, note));
    smooth_.begin_anew();
    known_ = false;
  }
  /// What is left of r at a time in the piece that has begun.
  double rest_at(double t, double b) const { return rest_ == 0.0 ? 0.0 : rest_ * std::exp((begin_ - t) / b); }

 private:
  static constexpr double little = 1e-9;  // of the curve: a rest that does not count

  /// For extremes of S: V there.
  template <class Note>
  auto with_rest(double b, Note&& note) const {
    return [this, b, &note](double value, double at, bool outward) { note(value + rest_at(at, b), at, outward); };
  }

  ExtremumTracker smooth_;
  double time_ = 0.0, relaxed_ = 0.0;  // the latest sample
  double begin_ = 0.0, rest_ = 0.0;    // of the piece, s, and what is left of r there
  bool known_ = false;
};

}  // namespace traverse::app
