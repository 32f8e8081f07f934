// Samples of the responses in the lanes of a batch of passages, and their peaks: the largest samples, and the vertices
// of parabolas through three of them.
#pragma once

#include "modal_engine/moving_force_motion.hpp"

namespace traverse::modal_engine {
namespace {

template <int W>
class ForceSamples : Lanes<W> {
  using Own = Lanes<W>;
  using Own::any;
  using Own::exceeds;
  using Own::fill;
  using Own::in_a_row;
  using Own::lanes;
  using Own::magnitude;

 public:
  using typename Own::Lane;
  using typename Own::Mask;

  ForceSamples(const ForceTask& task, const ForcedModes<W>& motion)
      : task_(task), modes_(task.modes), probes_(task.probes), motion_(motion) {}

  void lay_out(double* work, long& used) {
    const auto in_lanes = [&](long count) { return allocate_from<Lane>(work, used, W, count); };
    const auto numbers = [&](long count) { return allocate_from<double>(work, used, W, count); };
    for (int k = 0; k < 3; ++k) {
      Instant& own = instants_[k];
      last_[k] = &own;
      Lane** const of_modes_then[] = {&own.q, &own.r, &own.a};
      for (Lane** then : of_modes_then) *then = in_lanes(modes_);
      own.static_part = numbers(2L * probes_);
      own.flagged = allocate_from<int>(work, used, W, 3L * probes_);
      own.value = in_lanes(3L * probes_);
    }
    Lane** const of_responses[] = {&peak, &place, &limit_, &kink_value_};
    for (Lane** own : of_responses) *own = in_lanes(3L * probes_);
    accelerations_.first = allocate_from<int>(work, used, W, probes_);
    others_.first = allocate_from<int>(work, used, W, probes_);
    kink_sample_ = allocate_from<long>(work, used, W, 3L * probes_);
    kink_place_ = numbers(3L * probes_);
    limit_alone_ = numbers(3L * probes_);
  }

  void begin() {
    for (int i = 0; i < 3 * probes_; ++i) {
      peak[i] = lanes(task_.peak)[i];
      place[i] = fill(-1.0);
      limit_[i] = near_largest * peak[i];
      limit_alone_[i] = limit_[i][0];
      kink_sample_[i] = -1;
    }
  }

  /// Finds the responses of interest in a window: those with a bound above the peak of some run. Returns false if there
  /// are none.
  bool begin_window(const Lane* bound) {
    bound_ = bound;
    first_sample_ = samples_ + 1;
    accelerations_.count = others_.count = 0;
    const int size = group_size();
    for (int p = 0; p < probes_; p += size) {
      const int past = p + size < probes_ ? p + size : probes_;
      const bool acceleration = may_exceed(probes_ + p, probes_ + past);
      const bool other = may_exceed(p, past) || may_exceed(2 * probes_ + p, 2 * probes_ + past);
      if (acceleration) accelerations_.first[accelerations_.count++] = p;
      if (other || (in_rows() && acceleration)) others_.first[others_.count++] = p;
    }
    return accelerations_.count + others_.count > 0;
  }
  void end_window() {
    for (int k = 0; k < last_[2]->count && any(runs); ++k) check_last_sample(last_[2]->flagged[k]);
  }

  /// Samples the responses of interest at this distance.
  void sample() {
    Instant* const oldest = last_[0];
    last_[0] = last_[1];
    last_[1] = last_[2];
    last_[2] = oldest;
    ++samples_;
    Instant& now = *oldest;
    now.place = motion_.s;
    for (int i = 0; i < modes_; ++i) {
      now.q[i] = motion_.q[i];
      now.r[i] = motion_.r[i];
      now.a[i] = motion_.a[i];
    }
    if (others_.count > 0) evaluate_static_parts(now.static_part);
    now.count = 0;
    for (int g = 0; g < others_.count; ++g) flag_others(others_.first[g], now);
    if (!in_rows())
      for (int g = 0; g < accelerations_.count; ++g) flag_accelerations(accelerations_.first[g], now);
    for (int k = 0; k < now.count; ++k) record_largest(now.flagged[k], runs, magnitude(now.value[k]), fill(motion_.s));
    if (samples_ < first_sample_ + 2) return;
    const Instant& last = *last_[1];
    for (int k = 0; k < last.count; ++k) check_vertex(last.flagged[k], last.value[k]);
    if (samples_ > first_sample_ + 2) return;
    const Instant& first = *last_[0];
    for (int k = 0; k < first.count; ++k) check_first_sample(first.flagged[k], first.value[k]);
  }

  /// Samples the runs of a mask at separate distances, to which the modes have moved.
  void sample_ends(Mask ending, Lane at) {
    const Lane since = at - task_.start[motion_.interval];
    for (int i = 0; i < 3 * probes_; ++i) {
      if (!exceeds(bound_[i], peak[i])) continue;
      Lane static_part{};
      if (i < probes_ || i >= 2 * probes_) static_part = static_in_lanes(i, since);
      const Lane value = response(i, static_part, motion_.q, motion_.r, motion_.a);
      record_largest(i, ending, magnitude(value), at);
      check_last_vertex(i, ending, at, value);
    }
  }

  /// Samples a response before its kink, at the end of a smooth curve.
  void sample_before_kink(int i) {
    if (!exceeds(bound_[i], peak[i])) return;
    const Lane value = response(i, fill(static_value(i)), motion_.q, motion_.r, motion_.a);
    record_largest(i, runs, magnitude(value), fill(motion_.s));
    check_last_vertex(i, runs, fill(motion_.s), value);
  }

  /// Starts a new curve after the kink; earlier samples do not belong to it.
  void start_after_kink(int i) {
    if (!exceeds(bound_[i], peak[i])) return;
    kink_value_[i] = response(i, fill(static_value(i)), motion_.q, motion_.r, motion_.a);
    record_largest(i, runs, magnitude(kink_value_[i]), fill(motion_.s));
    kink_sample_[i] = samples_;
    kink_place_[i] = motion_.s;
  }

  Mask runs{};  // runs that have not ended
  // For each response: its largest magnitude so far, and the distance travelled at that instant in m; below 0: none.
  Lane *peak = nullptr, *place = nullptr;

 private:
  // Limit relative to the largest magnitude so far. The vertex of a parabola exceeds the middle point by at most an
  // eighth of the drop to the next point. For points a twentieth of a period apart the drop beside a peak is less than
  // 16 %. Therefore a middle point below this limit cannot lead to a larger peak.
  static constexpr double near_largest = 0.98;
  static constexpr double least_gap =
      1e-6;  // relative to the next distance: points closer than this define no parabola

  bool may_exceed(int first, int past) const {
    Mask greater{};
    for (int i = first; i < past; ++i) greater |= bound_[i] > peak[i];
    return any(greater & runs);
  }

  /// Groups of neighbouring probes with responses of interest in this window.
  struct Groups {
    int* first = nullptr;  // first probe of each
    int count = 0;
  };
  /// A single run has neighbouring probes in the lanes of a vector.
  bool in_rows() const { return task_.runs == 1; }
  int group_size() const { return in_rows() ? in_a_row : 4; }

  /// The part of a response without the modes: the static correction and the self-weight.
  const double* static_of(int i) const {
    return task_.coefficients + 4 * task_.channels * motion_.interval + modes_ + (i < probes_ ? i : i - probes_);
  }
  double static_value(int i) const {
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

  /// A response for these coordinates, rates and accelerations of the modes.
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

  /// A sample: the modes, the static corrections, and the responses that may be the largest.
  struct Instant {
    double place = 0.0;  // m travelled
    Lane *q = nullptr, *r = nullptr, *a = nullptr;
    double* static_part = nullptr;
    int* flagged = nullptr;
    Lane* value = nullptr;  // values of the flagged responses
    int count = 0;
  };
  Lane response(int i, const Instant& then) const {
    const double static_part = i < probes_       ? then.static_part[i]
                               : i < 2 * probes_ ? 0.0
                                                 : then.static_part[i - probes_];
    return response(i, fill(static_part), then.q, then.r, then.a);
  }

  void evaluate_static_parts(double* static_part) const {
    const double d = motion_.s - task_.start[motion_.interval];
    const long k = task_.channels;
    const double* c = task_.coefficients + 4 * k * motion_.interval + modes_;
    for (int i = 0; i < 2 * probes_; ++i)
      static_part[i] = task_.weight[i] + (c[i] + d * (c[k + i] + d * (c[2 * k + i] + d * c[3 * k + i])));
  }

  /// Flags the accelerations of a group of probes that may be the largest.
  void flag_accelerations(int p, Instant& now) const {
    if (p + 4 <= probes_) return flag_accelerations_of<4>(p, now);
    for (; p < probes_; ++p) flag_accelerations_of<1>(p, now);
  }
  /// The same for deflections and moments; for single runs all responses.
  void flag_others(int p, Instant& now) const {
    if (in_rows() && p + in_a_row <= probes_) return flag_row(p, now);
    if (!in_rows() && p + 4 <= probes_) return flag_others_of<4>(p, now);
    for (; p < probes_; ++p) {
      flag_others_of<1>(p, now);
      if (in_rows()) flag_accelerations_of<1>(p, now);
    }
  }

  template <int N>
  void flag_accelerations_of(int p, Instant& now) const {
    Lane a[N]{};
    for (int i = 0; i < modes_; ++i) {
      const double* form = task_.deflection + i * probes_ + p;
      const Lane acceleration = now.a[i];
#pragma GCC unroll 4
      for (int k = 0; k < N; ++k) a[k] += form[k] * acceleration;
    }
    const Lane* limit = limit_ + probes_ + p;
    int larger = 0;
#pragma GCC unroll 4
    for (int k = 0; k < N; ++k) larger |= exceeds(magnitude(a[k]), limit[k]);
    if (larger == 0) return;
#pragma GCC unroll 4
    for (int k = 0; k < N; ++k) flag(probes_ + p + k, a[k], now);
  }

  template <int N>
  void flag_others_of(int p, Instant& now) const {
    Lane v[N], M[N];
#pragma GCC unroll 4
    for (int k = 0; k < N; ++k) {
      v[k] = fill(now.static_part[p + k]);
      M[k] = fill(now.static_part[probes_ + p + k]);
    }
    for (int i = 0; i < modes_; ++i) {
      const int at = i * probes_ + p;
      const double *form = task_.deflection + at, *bend = task_.moment + at;
      const double *by_rate = task_.moment_by_rate + at, *by_acceleration = task_.moment_by_acceleration + at;
      const Lane q = now.q[i], rate = now.r[i], acceleration = now.a[i];
#pragma GCC unroll 4
      for (int k = 0; k < N; ++k) {
        v[k] += form[k] * q;
        M[k] += bend[k] * q;
        M[k] += by_rate[k] * rate;
        M[k] += by_acceleration[k] * acceleration;
      }
    }
    const Lane *of_v = limit_ + p, *of_M = of_v + 2 * probes_;
    int larger = 0;
#pragma GCC unroll 4
    for (int k = 0; k < N; ++k) larger |= exceeds(magnitude(v[k]), of_v[k]) | exceeds(magnitude(M[k]), of_M[k]);
    if (larger == 0) return;
#pragma GCC unroll 4
    for (int k = 0; k < N; ++k) {
      flag(p + k, v[k], now);
      flag(2 * probes_ + p + k, M[k], now);
    }
  }

  void flag(int i, Lane value, Instant& now) const {
    now.flagged[now.count] = i;
    now.value[now.count] = value;
    now.count += exceeds(magnitude(value), limit_[i]) != 0 ? 1 : 0;
  }

  /// Flags all responses of a group of probes that may be the largest, for a single run: the lanes are the probes.
  void flag_row(int p, Instant& now) const {
    using Row = Lanes<in_a_row>;
    const auto at = [](const double* numbers) { return *reinterpret_cast<const typename Row::Unaligned*>(numbers); };
    typename Row::Lane v = at(now.static_part + p), a{}, M = at(now.static_part + probes_ + p);
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

  /// Records a value, which cannot exceed the bound; an interpolated one might do so slightly.
  void record_largest(int i, Mask where, Lane value, Lane at) {
    value = value < bound_[i] ? value : bound_[i];
    const Mask larger = where & (value > peak[i]);
    peak[i] = larger ? value : peak[i];
    place[i] = larger ? at : place[i];
    limit_[i] = near_largest * peak[i];
    limit_alone_[i] = limit_[i][0];
  }

  /// Interpolates a peak near the second last sample, where the response has the value `middle`.
  void check_vertex(int i, Lane middle) {
    if (kink_sample_[i] == samples_ - 1) return;
    const Lane after = response(i, *last_[2]);
    const Mask turns = runs & (magnitude(middle) > limit_[i]) & (magnitude(middle) > magnitude(after));
    if (!any(turns)) return;
    const bool kink = kink_sample_[i] == samples_ - 2;
    record_vertex(i, turns, kink ? kink_place_[i] : last_[0]->place, kink ? kink_value_[i] : response(i, *last_[0]),
                  last_[1]->place, middle, fill(last_[2]->place), after);
  }

  /// Interpolates a peak between the first two samples of a window, or between the last two.
  void check_first_sample(int i, Lane first) {
    if (kink_sample_[i] >= first_sample_) return;
    const Lane middle = response(i, *last_[1]);
    const Mask turns = runs & (magnitude(first) > limit_[i]) & (magnitude(first) > magnitude(middle));
    if (any(turns))
      record_vertex(i, turns, last_[0]->place, first, last_[1]->place, middle, fill(last_[2]->place),
                    response(i, *last_[2]));
  }
  void check_last_sample(int i) {
    if (samples_ < first_sample_ + 2 || kink_sample_[i] >= samples_ - 2) return;
    const Lane middle = response(i, *last_[1]), last = response(i, *last_[2]);
    const Mask turns = runs & (magnitude(last) > limit_[i]) & (magnitude(last) > magnitude(middle));
    if (any(turns))
      record_vertex(i, turns, last_[0]->place, response(i, *last_[0]), last_[1]->place, middle, fill(last_[2]->place),
                    last);
  }

  /// Interpolates a peak near the last sample, before a later value.
  void check_last_vertex(int i, Mask where, Lane at, Lane after) {
    if (kink_sample_[i] == samples_ || samples_ <= first_sample_) return;
    const Lane middle = response(i, *last_[2]);
    const Mask turns = where & (magnitude(middle) > limit_[i]) & (magnitude(middle) > magnitude(after));
    if (!any(turns)) return;
    const bool kink = kink_sample_[i] == samples_ - 1;
    record_vertex(i, turns, kink ? kink_place_[i] : last_[1]->place, kink ? kink_value_[i] : response(i, *last_[1]),
                  last_[2]->place, middle, at, after);
  }

  /// The vertex of the parabola through three points, if it is a peak of the magnitude between the first and the last.
  void record_vertex(int i, Mask where, double s0, Lane y0, double s1, Lane y1, Lane s2, Lane y2) {
    const Lane sign = y1 < Lane{} ? fill(-1.0) : fill(1.0);
    y0 *= sign;
    y1 *= sign;
    y2 *= sign;
    const Lane gap = fill(s1 - s0), next = s2 - s1;
    const Lane before = (y1 - y0) / gap, after = (y2 - y1) / next;
    const Lane bend = (after - before) / (gap + next);
    const Lane at = 0.5 * (s0 + s1) - 0.5 * before / bend;
    where &= (bend < Lane{}) & (at > fill(s0)) & (at < s2) & (gap > least_gap * next) & (next > least_gap * gap);
    if (any(where)) record_largest(i, where, y1 + (at - s1) * (before + bend * (at - s0)), at);
  }

  const ForceTask& task_;
  const int modes_, probes_;
  const ForcedModes<W>& motion_;
  Instant instants_[3], *last_[3] = {};  // the last samples, in cyclic order
  long samples_ = 0, first_sample_ = 1;  // number of samples; first one of this window
  Groups accelerations_, others_;        // with accelerations, and with deflections or moments of interest
  const Lane* bound_ = nullptr;          // of each response in this window
  // For each response: the limit for larger values, and the limit in the first lane.
  Lane* limit_ = nullptr;
  double* limit_alone_ = nullptr;
  long* kink_sample_ = nullptr;   // for each response: the sample before its last kink
  double* kink_place_ = nullptr;  // m: position of the kink
  Lane* kink_value_ = nullptr;    // value just after the kink
};

}  // namespace
}  // namespace traverse::modal_engine
