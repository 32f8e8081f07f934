// Trackers of the extremes of sampled curves. Between samples a curve is interpolated by a polynomial of degree four.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

#include "base/bytes.hpp"
#include "base/extremum.hpp"

namespace traverse::run {

using base::Extreme;

/// The latest samples in ascending order of time; times in s.
struct Samples {
  static constexpr std::size_t max_count = base::samples_kept;
  std::array<double, max_count> time{}, value{};
  std::size_t count = 0;  // number of samples added so far

  void push(double t, double y) {
    std::rotate(time.begin(), time.begin() + 1, time.end());
    std::rotate(value.begin(), value.begin() + 1, value.end());
    time.back() = t;
    value.back() = y;
    ++count;
  }
};

/// The extreme of the curve near sample i, which is extreme between its neighbours. smooth(a, b): whether the curve has
/// no kink from sample a to sample b. With three samples, a neighbour much closer than the other neighbour is replaced
/// by the next sample behind it; if that does not exist, the extreme is the sample itself.
template <class Smooth>
Extreme interpolate_extremum(const Samples& samples, std::size_t i, Smooth&& smooth) {
  const auto &t = samples.time, &y = samples.value;
  const base::Stencil by(t.data(), static_cast<int>(i),
                         static_cast<int>(Samples::max_count - std::min(samples.count, Samples::max_count)));
  const auto left = static_cast<std::size_t>(by.left), right = static_cast<std::size_t>(by.right);
  const bool five = by.five && smooth(0, 4);
  const bool is_extreme = (y[i] - y[left]) * (y[right] - y[i]) <= 0.0 && y[right] != y[i];
  if (!five && !(by.three && is_extreme && smooth(left, right))) return {y[i], t[i]};
  double offset = 0.0;
  const double extreme = base::extreme_between(t.data(), y.data(), static_cast<int>(i), by, five, offset);
  return {extreme, t[i] + offset};
}

/// The latest times at which a curve has a kink, s.
class KinkTimes {
 public:
  KinkTimes() { times_.fill(-std::numeric_limits<double>::infinity()); }
  void add(double t) { times_[next_++ % times_.size()] = t; }
  /// Whether there is one from `from` to `to`, the times of two of the latest samples.
  bool between(double from, double to) const {
    return std::any_of(times_.begin(), times_.end(), [=](double t) { return t >= from && t <= to; });
  }

 private:
  std::array<double, 2 * Samples::max_count> times_;
  std::size_t next_ = 0;
};
inline const KinkTimes no_kinks;

/// The extremes of one curve, evaluated as samples arrive. For each extreme record(value, time, outward) is called;
/// outward: its magnitude is extreme too, i.e. it is a maximum above zero or a minimum below.
class ExtremumTracker {
 public:
  /// Adds a sample and records the extreme two samples before it, if any. kinks: those of the curve.
  template <class Record>
  void add(double t, double value, const KinkTimes& kinks, Record&& record) {
    const double latest = samples_.time[4];
    if (samples_.count > 1 && t - latest < min_ratio * (latest - samples_.time[3])) {
      if (std::abs(value) > std::abs(samples_.value[4]))
        std::tie(samples_.time[4], samples_.value[4]) = std::tie(t, value);
      return;
    }
    samples_.push(t, value);
    if (samples_.count == 1) return record(value, t, true);
    if (samples_.count >= 4) evaluate(2, kinks, record);
  }
  /// After the last sample: records the extreme just before it, if any.
  template <class Record>
  void record_last(const KinkTimes& kinks, Record&& record) const {
    if (samples_.count >= 3) evaluate(3, kinks, record);
  }
  /// Like record_last(), and records the last value too.
  template <class Record>
  void finish(const KinkTimes& kinks, Record&& record) const {
    record_last(kinks, record);
    if (samples_.count > 0) record(samples_.value.back(), samples_.time.back(), true);
  }
  /// Removes all samples.
  void reset() { samples_ = {}; }

 private:
  // Smallest ratio of two successive intervals. Between instants that are closer the slope is determined by rounding
  // errors, and a parabola would overshoot.
  static constexpr double min_ratio = 1e-2;

  /// Records the sample at i if it is extreme.
  template <class Record>
  void evaluate(std::size_t i, const KinkTimes& kinks, Record&& record) const {
    const auto &t = samples_.time, &y = samples_.value;
    const bool outward = std::abs(y[i]) >= std::abs(y[i - 1]) && std::abs(y[i]) > std::abs(y[i + 1]);
    if (!outward && !((y[i] - y[i - 1]) * (y[i + 1] - y[i]) < 0.0)) return;
    const Extreme extremum = interpolate_extremum(samples_, i, [&](std::size_t from, std::size_t to) {
      return y[from] * y[to] > 0.0 && !kinks.between(t[from], t[to]);
    });
    record(extremum.value, extremum.time, outward);
  }

  Samples samples_;
};

/// The extremes of a curve M + b dM/dt, where M is smooth except for its kinks, which have samples.
class LaggedMomentTracker {
 public:
  /// b in s.
  template <class Record>
  void add(double t, double value, double rate, double b, Record&& record) {
    const double h = t - time_, before = rate_, start = value_;
    if (!known_) record(value, t, true);
    if (known_ && h > 0.0 && before * rate < 0.0) {
      double later = 0.0;
      const double extreme = base::extreme_of_lagging(h, start, value, before, rate, b, later);
      record(extreme, time_ + later, before * start > 0.0);
    }
    time_ = t;
    value_ = value;
    rate_ = rate;
    known_ = true;
  }
  template <class Record>
  void finish(Record&& record) const {
    if (known_) record(value_, time_, true);
  }

 private:
  double time_ = 0.0, value_ = 0.0, rate_ = 0.0;  // the latest sample
  bool known_ = false;
};

/// The extreme behind a jump of S from one value to another, for V = S + (before - after) exp(-t/b) where S continues
/// with the given slope; b = 0: S itself.
struct JumpExtremum {
  bool exists = false;
  double value = 0.0, later = 0.0;  // s after the jump
};
inline JumpExtremum extremum_after_jump(double before, double after, double slope, double b) {
  if (b == 0.0) return {true, after, 0.0};
  const double duration = b * std::log((before - after) / (b * slope));
  return {duration > 0.0 && std::isfinite(duration), after + slope * (duration + b), duration};
}

/// The extremes of a curve over time with jumps when loads pass the probe: shear or axial force. The curve consists of
/// pieces between two such passages. With damping b K it relaxes after a jump, V = S + r exp(-t/b), where S is smooth.
class JumpingCurve {
 public:
  /// relaxed: S; unrelaxed: the remaining part of r, used at the begin of a piece. b in s; 0: the curve is S.
  template <class Record>
  void add(double t, double relaxed, double unrelaxed, double b, Record&& record) {
    if (!known_) {
      begin_ = t;
      transient_ = b > 0.0 ? unrelaxed : 0.0;
    } else if (const double transient = transient_at(time_, b); std::abs(transient) > negligible * std::abs(relaxed)) {
      const double slope = (relaxed - relaxed_) / (t - time_);
      const JumpExtremum extremum = extremum_after_jump(relaxed_ + transient, relaxed_, slope, b);
      if (extremum.exists && extremum.later < t - time_)
        record(extremum.value, time_ + extremum.later, slope * extremum.value < 0.0);
    }
    time_ = t;
    relaxed_ = relaxed;
    known_ = true;
    smooth_.add(t, relaxed, no_kinks, with_transient(b, record));
  }
  /// After the last sample of a piece; then a new piece begins.
  template <class Record>
  void finish(double b, Record&& record) {
    smooth_.finish(no_kinks, with_transient(b, record));
    smooth_.reset();
    known_ = false;
  }
  /// The part of r that remains at a time in the present piece between two passages.
  double transient_at(double t, double b) const {
    return transient_ == 0.0 ? 0.0 : transient_ * std::exp((begin_ - t) / b);
  }

 private:
  static constexpr double negligible = 1e-9;  // relative to the curve: smaller values of r are neglected

  /// Records extremes of S with the value of V.
  template <class Record>
  auto with_transient(double b, Record&& record) const {
    return
        [this, b, &record](double value, double at, bool outward) { record(value + transient_at(at, b), at, outward); };
  }

  ExtremumTracker smooth_;
  double time_ = 0.0, relaxed_ = 0.0;     // the latest sample
  double begin_ = 0.0, transient_ = 0.0;  // begin of the piece, s, and the value of r there
  bool known_ = false;
};

}  // namespace traverse::run
