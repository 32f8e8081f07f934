// Passages of the same moving forces at several speeds, one in each SIMD lane. All runs are sampled at the same
// distances, so that the static correction is the same number in every lane.
//
// The modes move exactly from window to window. Only windows with a bound above the largest value so far are sampled,
// at regular intervals, and peaks between samples are interpolated by parabolas. When a force passes a break of the
// influence lines in a window, only the responses with a kink there are sampled.
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
    while (begin_windows()) {
      if (task_.only_bounds)
        record_bounds();
      else
        sample_windows();
      if (!task_.proceed(task_.context)) return;
    }
    for (int i = 0; i < 3 * probes_; ++i) {
      lanes(task_.peak)[i] = peak_[i];
      lanes(task_.peak_time)[i] = peak_place_[i] / speed_;
    }
  }

 private:
  // Limit relative to the largest magnitude so far. The vertex of a parabola exceeds the middle point by at most an
  // eighth of the drop to the next point. For points a twentieth of a period apart the drop beside a peak is less than
  // 16 %. Therefore a middle point below this limit cannot lead to a larger peak.
  static constexpr double near_largest = 0.98;
  static constexpr double least_parts = 2.0;  // of a window: three samples define a parabola
  static constexpr double least_gap =
      1e-6;  // relative to the next distance: points closer than this define no parabola
  static constexpr double same_end = 1.0 + 1e-12;       // equal distances except for rounding
  static constexpr double same_step = 1.0 - 1e-9;       // equal steps except for rounding
  static constexpr double rounding = 1e-9;              // relative error of bounds, and much more
  // Vectors for windows that are treated together, and number of these windows.
  static constexpr long most_vectors = 1024, least_windows = 16;

  // --- memory ------------------------------------------------------------------------------------------------------

  void lay_out(double* work) {
    const auto in_lanes = [&](long count) { return allocate_from<Lane>(work, used_, W, count); };
    const auto numbers = [&](long count) { return allocate_from<double>(work, used_, W, count); };
    motion_.lay_out(work, used_);
    for (int k = 0; k < 3; ++k) {
      Instant& own = instants_[k];
      last_[k] = &own;
      Lane** const of_modes_then[] = {&own.q, &own.r, &own.a};
      for (Lane** then : of_modes_then) *then = in_lanes(modes_);
      own.static_part = numbers(2L * probes_);
      own.flagged = allocate_from<int>(work, used_, W, 3L * probes_);
      own.value = in_lanes(3L * probes_);
    }
    amplitude_ = in_lanes(modes_);
    const long vectors = 2L * modes_ + 3L * probes_;  // of a window
    capacity_ = most_vectors / vectors;
    if (capacity_ < least_windows || task_.only_bounds) capacity_ = least_windows;
    windows_ = allocate_from<Window>(work, used_, W, capacity_);
    Lane* const of_windows = in_lanes(capacity_ * vectors);
    for (long k = 0; work != nullptr && k < capacity_; ++k) {
      windows_[k].state = of_windows + k * vectors;
      windows_[k].bound = windows_[k].state + 2L * modes_;
    }
    end_state_ = in_lanes(2L * modes_);
    Lane** const of_responses[] = {&peak_, &peak_place_, &limit_, &kink_value_};
    for (Lane** own : of_responses) *own = in_lanes(3L * probes_);
    kink_sample_ = allocate_from<long>(work, used_, W, 3L * probes_);
    kink_place_ = numbers(3L * probes_);
    limit_alone_ = numbers(3L * probes_);
  }

  // --- start -------------------------------------------------------------------------------------------------------

  void begin() {
    speed_ = *lanes(task_.speed);
    end_ = *lanes(task_.end);
    for (int i = 0; i < 3 * probes_; ++i) {
      peak_[i] = lanes(task_.peak)[i];
      peak_place_[i] = fill(-1.0);
      limit_[i] = near_largest * peak_[i];
      limit_alone_[i] = limit_[i][0];
      kink_sample_[i] = -1;
    }
    motion_.begin();
  }

  // --- windows -----------------------------------------------------------------------------------------------------

  /// A window with the state at its start and the bounds of the responses in it.
  struct Window {
    double start, end;  // m travelled
    long number, interval, last_interval;
    Lane *state, *bound;
    bool sampled;
  };

  /// Finds the runs that have not ended at this distance; false after the end of all runs.
  bool find_runs(double at) {
    runs_ = at > 0.0 ? end_ > fill(at * same_end) : end_ >= Lane{};
    return any(runs_);
  }

  /// Moves through as many windows as memory permits; false if there is none before the end of all runs.
  bool begin_windows() {
    for (count_ = 0; count_ < capacity_ && find_runs(motion_.s); ++count_) {
      Window& own = windows_[count_];
      const bool repeats = next_window_ + 1 == task_.windows;
      own.number = next_window_;
      own.start = motion_.s;
      own.interval = motion_.interval;
      own.end = repeats ? motion_.s + task_.last_window : task_.window_end[next_window_];
      own.sampled = false;
      motion_.copy_state(own.state);
      find_bounds(own);
      for (long k = task_.first_move[own.number]; k < task_.first_move[own.number + 1]; ++k) {
        own.last_interval = motion_.interval;
        motion_.make_move(k, repeats ? own.end : task_.move_end[k]);
      }
      motion_.place_again();
      if (!repeats) ++next_window_;
    }
    return count_ > 0;
  }

  /// Bounds of all responses in this window (force_bounds.hpp).
  void find_bounds(Window& own) const {
    const double *mode = task_.window_numbers + own.number * (2L * modes_ + 6L * probes_);
    const double* response = mode + 2L * modes_;
    for (int i = 0; i < modes_; ++i) amplitude_[i] = motion_.amplitude(i) + mode[2 * i] * speed_ + mode[2 * i + 1];
    const int count = 3 * probes_;
    for (int i = 0; i < count; ++i) {
      Lane sum = response[i] + response[count + i] * speed_;
      for (int k = 0; k < modes_; ++k) sum += task_.by_amplitude[k * count + i] * amplitude_[k];
      own.bound[i] = (1.0 + rounding) * sum;
    }
  }
  void record_bounds() {
    for (long k = 0; k < count_; ++k) {
      find_runs(windows_[k].start);
      const Lane* bound = windows_[k].bound;
      for (int i = 0; i < 3 * probes_; ++i) peak_[i] = runs_ & (bound[i] > peak_[i]) ? bound[i] : peak_[i];
    }
  }

  /// Samples the windows that may have a peak: those with the largest bounds first, so that the others hardly have one.
  void sample_windows() {
    const double end = motion_.s;
    const long end_interval = motion_.interval;
    motion_.copy_state(end_state_);
    for (int i = 0; i < 3 * probes_; ++i) sample_window(windows_[largest_bound(i)]);
    for (long k = 0; k < count_; ++k) sample_window(windows_[k]);
    motion_.set_state(end_state_, end_interval, end);
  }
  /// The window with the largest bound of a response, in the mean of all runs.
  long largest_bound(int response) const {
    long found = 0;
    double largest = 0.0;
    for (long k = 0; k < count_; ++k) {
      double sum = 0.0;
      for (int lane = 0; lane < W; ++lane) sum += Own::numbers(windows_[k].bound[response])[lane];
      if (sum > largest) {
        largest = sum;
        found = k;
      }
    }
    return found;
  }

  bool is_of_interest(const Window& own, int first, int past) const {
    Mask greater{};
    for (int i = first; i < past; ++i) greater |= own.bound[i] > peak_[i];
    return any(greater & runs_);
  }

  void sample_window(Window& own) {
    if (own.sampled || !find_runs(own.start)) return;
    accelerations_ = is_of_interest(own, probes_, 2 * probes_);
    others_ = is_of_interest(own, 0, probes_) || is_of_interest(own, 2 * probes_, 3 * probes_);
    if (!accelerations_ && !others_) return;
    own.sampled = true;
    bound_ = own.bound;
    last_interval_ = own.last_interval;
    find_next_end();
    motion_.set_state(own.state, own.interval, own.start);
    const double wanted = __builtin_ceil((own.end - own.start) / task_.ds * same_step);
    const double parts = wanted > least_parts ? wanted : least_parts, step = (own.end - own.start) / parts;
    motion_.set_step(step);
    first_sample_ = samples_ + 1;
    sample();
    for (double k = 1.0; k <= parts && any(runs_); k += 1.0) advance_to(k < parts ? own.start + k * step : own.end);
    for (int k = 0; k < last_[2]->count && any(runs_); ++k) check_last_sample(last_[2]->flagged[k]);
  }

  bool has_event_until(double to) const {
    return motion_.interval < last_interval_ && motion_.next_event() <= to;
  }

  void advance_to(double to) {
    if (!has_event_until(to)) {
      end_runs_until(to);
      motion_.move_regularly(to);
    } else {
      while (has_event_until(to)) {
        const double event = motion_.next_event();
        end_runs_until(event);
        motion_.move_to(event);
        pass_event();
      }
      end_runs_until(to);
      motion_.move_to(to);
    }
    sample();
  }

  // --- events ------------------------------------------------------------------------------------------------------

  void pass_event() {
    if (!others_) return motion_.enter_next();  // accelerations have no kinks within a window
    const int first = task_.first_kink[motion_.interval + 1], last = task_.first_kink[motion_.interval + 2];
    for (int k = first; k < last; ++k) sample_before_kink(task_.kink[k]);
    motion_.enter_next();
    for (int k = first; k < last; ++k) start_after_kink(task_.kink[k]);
  }

  /// Samples a response before its kink, at the end of a smooth curve.
  void sample_before_kink(int i) {
    const Lane value = response(i, fill(static_value(i)), motion_.q, motion_.r, motion_.a);
    record_largest(i, runs_, magnitude(value), fill(motion_.s));
    check_last_vertex(i, runs_, fill(motion_.s), value);
  }

  /// Starts a new curve after the kink; earlier samples do not belong to it.
  void start_after_kink(int i) {
    kink_value_[i] = response(i, fill(static_value(i)), motion_.q, motion_.r, motion_.a);
    record_largest(i, runs_, magnitude(kink_value_[i]), fill(motion_.s));
    kink_sample_[i] = samples_;
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

  /// Samples the runs that end before the distance `to`, which lies in this interval, at their ends.
  void end_runs_until(double to) {
    if (next_end_ > to * same_end) return;
    const Mask ending = runs_ & (end_ <= fill(to * same_end));
    const Lane at = ending ? end_ : fill(motion_.s);
    const Lane since = at - task_.start[motion_.interval];
    motion_.move_lanes(at);
    for (int i = 0; i < 3 * probes_; ++i) {
      Lane static_part{};
      if (i < probes_ || i >= 2 * probes_) static_part = static_in_lanes(i, since);
      const Lane value = response(i, static_part, motion_.q, motion_.r, motion_.a);
      record_largest(i, ending, magnitude(value), at);
      check_last_vertex(i, ending, at, value);
    }
    motion_.move_back();
    runs_ &= ~ending;
    find_next_end();
  }

  // --- samples -----------------------------------------------------------------------------------------------------

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

  /// Samples all responses at this distance.
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
    if (others_) evaluate_static_parts(now.static_part);
    now.count = 0;
    int p = 0;
    if (task_.runs == 1)
      for (; p + in_a_row <= probes_; p += in_a_row) flag_row(p, now);
    else
      for (; p + 4 <= probes_; p += 4) flag_large<4>(p, now);
    for (; p < probes_; ++p) flag_large<1>(p, now);
    for (int k = 0; k < now.count; ++k) record_largest(now.flagged[k], runs_, magnitude(now.value[k]), fill(motion_.s));
    if (samples_ < first_sample_ + 2) return;
    const Instant& last = *last_[1];
    for (int k = 0; k < last.count; ++k) check_vertex(last.flagged[k], last.value[k]);
    if (samples_ > first_sample_ + 2) return;
    const Instant& first = *last_[0];
    for (int k = 0; k < first.count; ++k) check_first_sample(first.flagged[k], first.value[k]);
  }

  void evaluate_static_parts(double* static_part) const {
    const double d = motion_.s - task_.start[motion_.interval];
    const long k = task_.channels;
    const double* c = task_.coefficients + 4 * k * motion_.interval + modes_;
    for (int i = 0; i < 2 * probes_; ++i)
      static_part[i] = task_.weight[i] + (c[i] + d * (c[k + i] + d * (c[2 * k + i] + d * c[3 * k + i])));
  }

  /// Flags the responses of N neighbouring probes that may be the largest, as far as they are of interest.
  template <int N>
  void flag_large(int p, Instant& now) const {
    if (others_) flag_others<N>(p, now);
    if (accelerations_) flag_accelerations<N>(p, now);
  }

  template <int N>
  void flag_accelerations(int p, Instant& now) const {
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

  /// Deflections and moments.
  template <int N>
  void flag_others(int p, Instant& now) const {
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
    for (int k = 0; k < N; ++k)
      larger |= exceeds(magnitude(v[k]), of_v[k]) | exceeds(magnitude(M[k]), of_M[k]);
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

  /// Like flag(), for a single run: here the lanes are neighbouring probes.
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
    const Mask larger = where & (value > peak_[i]);
    peak_[i] = larger ? value : peak_[i];
    peak_place_[i] = larger ? at : peak_place_[i];
    limit_[i] = near_largest * peak_[i];
    limit_alone_[i] = limit_[i][0];
  }

  /// Interpolates a peak near the second last sample, where the response has the value `middle`.
  void check_vertex(int i, Lane middle) {
    if (kink_sample_[i] == samples_ - 1) return;
    const Lane after = response(i, *last_[2]);
    const Mask turns = runs_ & (magnitude(middle) > limit_[i]) & (magnitude(middle) > magnitude(after));
    if (!any(turns)) return;
    const bool kink = kink_sample_[i] == samples_ - 2;
    record_vertex(i, turns, kink ? kink_place_[i] : last_[0]->place, kink ? kink_value_[i] : response(i, *last_[0]),
                  last_[1]->place, middle, fill(last_[2]->place), after);
  }

  /// Interpolates a peak between the first two samples of a window, or between the last two.
  void check_first_sample(int i, Lane first) {
    if (kink_sample_[i] >= first_sample_) return;
    const Lane middle = response(i, *last_[1]);
    const Mask turns = runs_ & (magnitude(first) > limit_[i]) & (magnitude(first) > magnitude(middle));
    if (any(turns))
      record_vertex(i, turns, last_[0]->place, first, last_[1]->place, middle, fill(last_[2]->place),
                    response(i, *last_[2]));
  }
  void check_last_sample(int i) {
    if (samples_ < first_sample_ + 2 || kink_sample_[i] >= samples_ - 2) return;
    const Lane middle = response(i, *last_[1]), last = response(i, *last_[2]);
    const Mask turns = runs_ & (magnitude(last) > limit_[i]) & (magnitude(last) > magnitude(middle));
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
  ForcedModes<W> motion_;
  long used_ = 0;
  Lane speed_{}, end_{};
  Mask runs_{};                          // runs that have not ended
  double next_end_ = 0.0;                // distance at which the next of these runs ends, m
  Instant instants_[3], *last_[3] = {};  // the last samples, in cyclic order
  Window* windows_ = nullptr;  // windows that are treated together
  long capacity_ = 0, count_ = 0, next_window_ = 0;
  Lane* end_state_ = nullptr;            // after these windows
  long last_interval_ = 0;               // of the window that is sampled
  bool accelerations_ = true, others_ = true;  // the responses of interest in it
  long samples_ = 0, first_sample_ = 1;  // number of samples; first one of this window
  // For each response: its largest magnitude so far, the distance travelled at that instant in m, the limit for larger
  // values, and the limit in the first lane.
  Lane *peak_ = nullptr, *peak_place_ = nullptr, *limit_ = nullptr;
  Lane *bound_ = nullptr, *amplitude_ = nullptr;  // in a window: of each response, and A of each mode
  double* limit_alone_ = nullptr;
  long* kink_sample_ = nullptr;   // for each response: the sample before its last kink
  double* kink_place_ = nullptr;  // m: position of the kink
  Lane* kink_value_ = nullptr;    // value just after the kink
};

}  // namespace
}  // namespace traverse::modal_engine
