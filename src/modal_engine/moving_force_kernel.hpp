// Passages of the same moving forces at several speeds, one in each lane of the processor's vectors. All runs look at
// the same distances: what the modes leave out, which is taken as static, is then the same number in every lane.
//
// Responses are looked at in regular instants, and peaks between them found by parabolas. Where a force passes a break
// of the influence lines, only those responses are looked at that have a kink there.
#pragma once

#include "modal_engine/moving_force_motion.hpp"

namespace traverse::modal_engine {
namespace {

template <int W>
class MovingForceBatch : Lanes<W> {
  using Own = Lanes<W>;
  using Own::any;
  using Own::exceeds;
  using Own::fill;
  using Own::in_a_row;
  using Own::lanes;
  using Own::magnitude;
  using typename Own::Lane;
  using typename Own::Mask;

 public:
  MovingForceBatch(const ForceTask& task, double* work)
      : task_(task), modes_(task.modes), probes_(task.probes), motion_(task) {
    lay_out(work);
  }
  long size() const { return used_ * W; }

  void run() {
    begin();
    for (long k = 1; any(runs_); ++k) {
      if (k % instants_unasked == 0 && !task_.going(task_.whom)) return;
      go_to_instant(static_cast<double>(k) * task_.ds);
    }
    for (int i = 0; i < 3 * probes_; ++i) {
      lanes(task_.peak)[i] = peak_[i];
      lanes(task_.peak_time)[i] = peak_place_[i] / speed_;
    }
  }

 private:
  // Of the largest so far: no vertex of a parabola whose middle point is less can be larger, as it lies above that by
  // an eighth of the drop to the next point at most, and points a twentieth of a period apart do not drop by 16 %
  // beside a peak.
  static constexpr double near_largest = 0.98;
  static constexpr double too_near = 1e-6;         // of the next distance: points that near do not make a parabola
  static constexpr double same_end = 1.0 + 1e-12;  // distances that are one but for rounding
  static constexpr long instants_unasked = 4096;   // between two questions whether to go on

  // --- memory ------------------------------------------------------------------------------------------------------

  void lay_out(double* work) {
    const auto in_lanes = [&](long count) { return take_from<Lane>(work, used_, W, count); };
    const auto numbers = [&](long count) { return take_from<double>(work, used_, W, count); };
    motion_.lay_out(work, used_);
    for (int k = 0; k < 3; ++k) {
      Instant& own = instants_[k];
      seen_[k] = &own;
      Lane** const of_modes_then[] = {&own.q, &own.r, &own.a};
      for (Lane** then : of_modes_then) *then = in_lanes(modes_);
      own.predicted = numbers(2L * probes_);
      own.flagged = take_from<int>(work, used_, W, 3L * probes_);
      own.value = in_lanes(3L * probes_);
    }
    Lane** const of_responses[] = {&peak_, &peak_place_, &limit_, &kink_value_};
    for (Lane** own : of_responses) *own = in_lanes(3L * probes_);
    kink_look_ = take_from<long>(work, used_, W, 3L * probes_);
    kink_place_ = numbers(3L * probes_);
    limit_alone_ = numbers(3L * probes_);
  }

  // --- start -------------------------------------------------------------------------------------------------------

  void begin() {
    speed_ = *lanes(task_.speed);
    end_ = *lanes(task_.end);
    runs_ = end_ >= Lane{};
    find_next_end();
    for (int i = 0; i < 3 * probes_; ++i) {
      peak_[i] = peak_place_[i] = limit_[i] = Lane{};
      limit_alone_[i] = 0.0;
      kink_look_[i] = -1;
    }
    motion_.begin();
    look();
  }

  void go_to_instant(double to) {
    if (motion_.next_event() > to) {
      end_runs_until(to);
      motion_.move_regularly(to);
    } else {
      while (motion_.next_event() <= to) {
        const double event = motion_.next_event();
        end_runs_until(event);
        motion_.move_to(event);
        pass_event();
      }
      end_runs_until(to);
      motion_.move_to(to);
    }
    look();
  }

  // --- events ------------------------------------------------------------------------------------------------------

  void pass_event() {
    const ForceEvent event = task_.event[motion_.interval + 1];
    if (event == ForceEvent::all_kink || event == ForceEvent::all_jump) {
      look();
      motion_.enter_next();
      if (event == ForceEvent::all_jump) {
        known_from_ = looked_ + 1;
        look();
      }
      known_from_ = looked_;
      return;
    }
    const int first = task_.first_kink[motion_.interval + 1], last = task_.first_kink[motion_.interval + 2];
    for (int k = first; k < last; ++k) see_before_kink(task_.kink[k]);
    motion_.enter_next();
    for (int k = first; k < last; ++k) start_after_kink(task_.kink[k]);
  }

  /// A response's curve ends here.
  void see_before_kink(int i) {
    const Lane value = response(i, fill(static_now(i)), motion_.q, motion_.r, motion_.a);
    note(i, runs_, magnitude(value), fill(motion_.s));
    see_between_last(i, runs_, fill(motion_.s), value);
  }

  /// Another one begins here: what was seen at the last instant does not belong to it.
  void start_after_kink(int i) {
    kink_value_[i] = response(i, fill(static_now(i)), motion_.q, motion_.r, motion_.a);
    note(i, runs_, magnitude(kink_value_[i]), fill(motion_.s));
    kink_look_[i] = looked_;
    kink_place_[i] = motion_.s;
  }

  // --- ends --------------------------------------------------------------------------------------------------------

  void find_next_end() {
    next_end_ = 1e300;
    const double* ends = reinterpret_cast<const double*>(&end_);
    const long* runs = reinterpret_cast<const long*>(&runs_);
    for (int l = 0; l < W; ++l)
      if (runs[l] != 0 && ends[l] < next_end_) next_end_ = ends[l];
  }

  /// Looks at the end of the runs that end before the distance `to`, which lies in this interval.
  void end_runs_until(double to) {
    if (next_end_ > to * same_end) return;
    const Mask ending = runs_ & (end_ <= fill(to * same_end));
    const Lane at = ending ? end_ : fill(motion_.s);
    const Lane since = at - task_.start[motion_.interval];
    motion_.move_apart(at);
    for (int i = 0; i < 3 * probes_; ++i) {
      Lane predicted{};
      if (i < probes_ || i >= 2 * probes_) predicted = static_in_lanes(i, since);
      const Lane value = response(i, predicted, motion_.q, motion_.r, motion_.a);
      note(i, ending, magnitude(value), at);
      see_between_last(i, ending, at, value);
    }
    motion_.move_back();
    runs_ &= ~ending;
    find_next_end();
  }

  // --- what is seen ------------------------------------------------------------------------------------------------

  /// A response without the modes: the static correction, and the beam's own weight.
  const double* static_of(int i) const {
    return task_.coefficients + 4 * task_.channels * motion_.interval + modes_ + (i < probes_ ? i : i - probes_);
  }
  double static_now(int i) const {
    if (i >= probes_ && i < 2 * probes_) return 0.0;
    const double *c = static_of(i), d = motion_.s - task_.start[motion_.interval];
    const long k = task_.channels;
    return task_.weight[i < probes_ ? i : i - probes_] + (c[0] + d * (c[k] + d * (c[2 * k] + d * c[3 * k])));
  }
  Lane static_in_lanes(int i, Lane d) const {
    const double* c = static_of(i);
    const long k = task_.channels;
    return task_.weight[i < probes_ ? i : i - probes_] + (c[0] + d * (c[k] + d * (c[2 * k] + d * c[3 * k])));
  }

  /// A response with these coordinates, rates and accelerations of the modes.
  Lane response(int i, Lane value, const Lane* q, const Lane* r, const Lane* a) const {
    if (i < probes_) {
      for (int k = 0; k < modes_; ++k) value += task_.deflection[k * probes_ + i] * q[k];
    } else if (i < 2 * probes_) {
      for (int k = 0; k < modes_; ++k) value += task_.deflection[k * probes_ + i - probes_] * a[k];
    } else {
      for (int k = 0; k < modes_; ++k) {
        const int at = k * probes_ + i - 2 * probes_;
        value += task_.moment[at] * q[k];
        value += task_.moment_by_rate[at] * r[k];
        value += task_.moment_by_acceleration[at] * a[k];
      }
    }
    return value;
  }

  /// What is kept of an instant: the modes, the static corrections, and the responses that may be the largest.
  struct Instant {
    double place = 0.0;  // m travelled
    Lane *q = nullptr, *r = nullptr, *a = nullptr;
    double* predicted = nullptr;
    int* flagged = nullptr;
    Lane* value = nullptr;  // of these
    int count = 0;
  };
  Lane response(int i, const Instant& then) const {
    const double predicted = i < probes_ ? then.predicted[i] : i < 2 * probes_ ? 0.0 : then.predicted[i - probes_];
    return response(i, fill(predicted), then.q, then.r, then.a);
  }

  /// All responses at this distance.
  void look() {
    Instant* const oldest = seen_[0];
    seen_[0] = seen_[1];
    seen_[1] = seen_[2];
    seen_[2] = oldest;
    ++looked_;
    Instant& now = *oldest;
    now.place = motion_.s;
    for (int i = 0; i < modes_; ++i) {
      now.q[i] = motion_.q[i];
      now.r[i] = motion_.r[i];
      now.a[i] = motion_.a[i];
    }
    observe_statics(now.predicted);
    now.count = 0;
    int p = 0;
    if (task_.runs == 1)
      for (; p + in_a_row <= probes_; p += in_a_row) observe_row(p, now);
    else
      for (; p + 4 <= probes_; p += 4) see<4>(p, now);
    for (; p < probes_; ++p) see<1>(p, now);
    for (int k = 0; k < now.count; ++k) note(now.flagged[k], runs_, magnitude(now.value[k]), fill(motion_.s));
    if (looked_ - 2 < known_from_) return;
    const Instant& last = *seen_[1];
    for (int k = 0; k < last.count; ++k) observe_between(last.flagged[k], last.value[k]);
  }

  void observe_statics(double* predicted) const {
    const double d = motion_.s - task_.start[motion_.interval];
    const long k = task_.channels;
    const double* c = task_.coefficients + 4 * k * motion_.interval + modes_;
    for (int i = 0; i < 2 * probes_; ++i)
      predicted[i] = task_.weight[i] + (c[i] + d * (c[k + i] + d * (c[2 * k + i] + d * c[3 * k + i])));
  }

  /// Flags those responses of N neighbouring probes that may be the largest.
  template <int N>
  void see(int p, Instant& now) const {
    Lane v[N], a[N], M[N];
#pragma GCC unroll 4
    for (int k = 0; k < N; ++k) {
      v[k] = fill(now.predicted[p + k]);
      a[k] = Lane{};
      M[k] = fill(now.predicted[probes_ + p + k]);
    }
    for (int i = 0; i < modes_; ++i) {
      const int at = i * probes_ + p;
      const double *form = task_.deflection + at, *bend = task_.moment + at;
      const double *by_rate = task_.moment_by_rate + at, *by_acceleration = task_.moment_by_acceleration + at;
      const Lane q = now.q[i], rate = now.r[i], acceleration = now.a[i];
#pragma GCC unroll 4
      for (int k = 0; k < N; ++k) {
        v[k] += form[k] * q;
        a[k] += form[k] * acceleration;
        M[k] += bend[k] * q;
        M[k] += by_rate[k] * rate;
        M[k] += by_acceleration[k] * acceleration;
      }
    }
    const Lane *of_v = limit_ + p, *of_a = of_v + probes_, *of_M = of_a + probes_;
    int larger = 0;
#pragma GCC unroll 4
    for (int k = 0; k < N; ++k) {
      larger |= exceeds(magnitude(v[k]), of_v[k]);
      larger |= exceeds(magnitude(a[k]), of_a[k]);
      larger |= exceeds(magnitude(M[k]), of_M[k]);
    }
    if (larger == 0) return;
#pragma GCC unroll 4
    for (int k = 0; k < N; ++k) {
      flag(p + k, v[k], now);
      flag(probes_ + p + k, a[k], now);
      flag(2 * probes_ + p + k, M[k], now);
    }
  }

  void flag(int i, Lane value, Instant& now) const {
    now.flagged[now.count] = i;
    now.value[now.count] = value;
    now.count += exceeds(magnitude(value), limit_[i]) != 0 ? 1 : 0;
  }

  /// As see() for a single run: here the lanes are neighbouring probes.
  void observe_row(int p, Instant& now) const {
    using Row = Lanes<in_a_row>;
    const auto at = [](const double* numbers) { return *reinterpret_cast<const typename Row::Unaligned*>(numbers); };
    typename Row::Lane v = at(now.predicted + p), a{}, M = at(now.predicted + probes_ + p);
    for (int i = 0; i < modes_; ++i) {
      const int k = i * probes_ + p;
      const double q = now.q[i][0], rate = now.r[i][0], acceleration = now.a[i][0];
      v += at(task_.deflection + k) * q;
      a += at(task_.deflection + k) * acceleration;
      M += at(task_.moment + k) * q;
      M += at(task_.moment_by_rate + k) * rate;
      M += at(task_.moment_by_acceleration + k) * acceleration;
    }
    const double* limit = limit_alone_ + p;
    if ((Row::exceeds(Row::magnitude(v), at(limit)) | Row::exceeds(Row::magnitude(a), at(limit + probes_)) |
         Row::exceeds(Row::magnitude(M), at(limit + 2 * probes_))) == 0)
      return;
    for (int k = 0; k < in_a_row; ++k) {
      flag(p + k, fill(v[k]), now);
      flag(probes_ + p + k, fill(a[k]), now);
      flag(2 * probes_ + p + k, fill(M[k]), now);
    }
  }

  void note(int i, Mask where, Lane value, Lane at) {
    const Mask larger = where & (value > peak_[i]);
    peak_[i] = larger ? value : peak_[i];
    peak_place_[i] = larger ? at : peak_place_[i];
    limit_[i] = near_largest * peak_[i];
    limit_alone_[i] = limit_[i][0];
  }

  /// The last instant but one, where a response had this value, may be beside a peak.
  void observe_between(int i, Lane middle) {
    if (kink_look_[i] == looked_ - 1) return;
    const Lane after = response(i, *seen_[2]);
    const Mask turns = runs_ & (magnitude(middle) > limit_[i]) & (magnitude(middle) > magnitude(after));
    if (!any(turns)) return;
    const bool kink = kink_look_[i] == looked_ - 2;
    record_vertex(i, turns, kink ? kink_place_[i] : seen_[0]->place, kink ? kink_value_[i] : response(i, *seen_[0]),
                  seen_[1]->place, middle, fill(seen_[2]->place), after);
  }

  /// The last instant may be, before a value further on.
  void see_between_last(int i, Mask where, Lane at, Lane after) {
    if (kink_look_[i] == looked_ || looked_ - 1 < known_from_) return;
    const Lane middle = response(i, *seen_[2]);
    const Mask turns = where & (magnitude(middle) > limit_[i]) & (magnitude(middle) > magnitude(after));
    if (!any(turns)) return;
    const bool kink = kink_look_[i] == looked_ - 1;
    record_vertex(i, turns, kink ? kink_place_[i] : seen_[1]->place, kink ? kink_value_[i] : response(i, *seen_[1]),
                  seen_[2]->place, middle, at, after);
  }

  /// The vertex of the parabola through three points, of whose magnitudes the middle one is the largest.
  void record_vertex(int i, Mask where, double s0, Lane y0, double s1, Lane y1, Lane s2, Lane y2) {
    const Lane sign = y1 < Lane{} ? fill(-1.0) : fill(1.0);
    y0 *= sign;
    y1 *= sign;
    y2 *= sign;
    const Lane gap = fill(s1 - s0), next = s2 - s1;
    where &= (y1 >= y0) & (gap > too_near * next) & (next > too_near * gap);
    if (!any(where)) return;
    const Lane before = (y1 - y0) / gap, after = (y2 - y1) / next;
    const Lane bend = (after - before) / (gap + next);
    const Lane at = 0.5 * (s0 + s1) - 0.5 * before / bend;
    note(i, where, y1 + (at - s1) * (before + bend * (at - s0)), at);
  }

  const ForceTask& task_;
  const int modes_, probes_;
  ForcedModes<W> motion_;
  long used_ = 0;
  Lane speed_{}, end_{};
  Mask runs_{};                          // which have not ended
  double next_end_ = 0.0;                // m: of these
  Instant instants_[3], *seen_[3] = {};  // the last ones, in turn
  long looked_ = 0, known_from_ = 1;     // instants so far; the first without a kink of all responses since
  // Of each response: its largest magnitude so far, m travelled then, what may be larger, the same of the first lane.
  Lane *peak_ = nullptr, *peak_place_ = nullptr, *limit_ = nullptr;
  double* limit_alone_ = nullptr;
  long* kink_look_ = nullptr;     // of each response: the instant before its last kink
  double* kink_place_ = nullptr;  // m: where that was
  Lane* kink_value_ = nullptr;    // just after it
};

}  // namespace
}  // namespace traverse::modal_engine
