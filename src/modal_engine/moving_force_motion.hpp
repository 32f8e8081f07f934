// The modal motion under the same moving forces at several speeds, one in each SIMD lane. All runs have the same steps
// in distance, so that the modal forces are the same number in every lane.
//
//   q'' + 2 sigma q' + omega^2 q = g,    g a cubic polynomial of the distance between two events
//
// The motion is exact in time. With O(t) the response to a unit impulse, O(0) = 0, O'(0) = 1, and Q_k the response to
// the force t^k/k!, Q_0 = int O, Q_k = int Q_(k-1), a state q, q', q'' moves to
//
//   q  (t) = q  + t    q'  + Q_0 q'' + Q_1 j   + Q_2 g'' + Q_3 g'''       j = g' - omega^2 q'
//   q' (t) = q' + O(t) q'' + Q_0 j   + Q_1 g'' + Q_2 g'''
//
// Q_3 and Q_2 are power series, which are valid for overdamped modes too; the others follow by Q_(k-2) = t^k/k! - 2
// sigma Q_(k-1) - omega^2 Q_k.
#pragma once

#include "engine/lane.hpp"
#include "modal_engine/moving_force_task.hpp"

namespace traverse::modal_engine {
namespace {

using engine::allocate_from;
using engine::Lanes;

template <int W>
class ForcedModes : Lanes<W> {
  using Own = Lanes<W>;
  using Own::fill;

 public:
  using typename Own::Lane;

  explicit ForcedModes(const ForceTask& task) : task_(task), modes_(task.modes) {}

  void lay_out(double* work, long& used) {
    Lane** const of_modes[] = {&q, &r, &a, &q_stored_, &r_stored_, &a_stored_};
    for (Lane** own : of_modes) *own = allocate_from<Lane>(work, used, W, modes_);
    regular_ = allocate_from<Advance>(work, used, W, modes_);
    by_length_ = allocate_from<Advance>(work, used, W, static_cast<long>(modes_) * task_.lengths);
    parts_of_length_ = allocate_from<double>(work, used, W, task_.lengths);
    series_ = allocate_from<Series>(work, used, W, modes_);
    for (double*& power : g_) power = allocate_from<double>(work, used, W, modes_);
  }

  void begin() {
    speed_ = *Own::lanes(task_.speed);
    set_series();
    for (int k = 0; k < task_.lengths; ++k) {
      parts_of_length_[k] = long_parts(task_.length[k]);
      const Lane part = fill(task_.length[k] / parts_of_length_[k]) / speed_;
      for (int i = 0; i < modes_; ++i) by_length_[k * modes_ + i] = advance_by(i, part, series_[i].long_terms);
    }
    for (int i = 0; i < modes_; ++i) {
      q[i] = fill(task_.q[i]);
      r[i] = Lane{};
    }
    place(0.0);
  }

  /// Sets the distance between samples, at most ForceTask::ds.
  void set_step(double step) {
    if (step == step_) return;
    step_ = step;
    const Lane part = fill(step / parts_) / speed_;
    for (int i = 0; i < modes_; ++i) regular_[i] = advance_by(i, part, series_[i].terms);
  }

  /// The distance travelled at the next event, m; infinite after the last event.
  double next_event() const { return interval + 1 < task_.intervals ? task_.start[interval + 1] : 1e300; }

  /// At an event: changes the modal forces to those after it.
  void enter_next() {
    ++interval;
    if (interval + 1 < task_.intervals) {
      const double* next = task_.coefficients + 4 * task_.channels * (interval + 1);
      for (int i = 0; i < 4 * task_.channels; i += 8) __builtin_prefetch(next + i);
    }
    place(s);
  }

  /// Moves from a sample to the next one, without an event between them.
  void move_regularly(double to) {
    const double from = s;
    for (double k = 1.0; k <= parts_; k += 1.0) {
      for (int i = 0; i < modes_; ++i) move(i, regular_[i], g_[1][i], g_[2][i], g_[3][i]);
      place(part_of(from, to, k, parts_));
    }
  }

  /// Moves to a distance at most one sampling interval away, not beyond the next event.
  void move_to(double to) {
    const double from = s;
    const Lane part = fill((to - from) / parts_) / speed_;
    for (double k = 1.0; k <= parts_; k += 1.0) {
      for (int i = 0; i < modes_; ++i) move(i, advance_by(i, part, series_[i].terms), g_[1][i], g_[2][i], g_[3][i]);
      place(part_of(from, to, k, parts_));
    }
  }

  /// Makes one move of the windows, up to the distance `to` in the same interval; place_again() follows after the last.
  void make_move(long number, double to) {
    const int length = task_.move_length[number];
    if (length >= 0 && parts_of_length_[length] == 1.0 && s == task_.start[interval])
      move_from_start(by_length_ + length * modes_);
    else
      move_in_parts(length, to);
    s = to;
    if (to == next_event()) ++interval;
  }
  void place_again() { place(s); }

  /// Copies the state to memory for 2 W numbers a mode; set_state() returns to it.
  void copy_state(Lane* state) const {
    for (int i = 0; i < modes_; ++i) {
      state[2 * i] = q[i];
      state[2 * i + 1] = r[i];
    }
  }
  void set_state(const Lane* state, long in_interval, double at) {
    for (int i = 0; i < modes_; ++i) {
      q[i] = state[2 * i];
      r[i] = state[2 * i + 1];
    }
    interval = in_interval;
    place(at);
  }

  /// The deviation of a mode from quasi-static motion (force_bounds.hpp) and its rate. flexibility: 1 / omega^2.
  Lane deviation(int i, double flexibility) const { return q[i] - flexibility * g_[0][i]; }
  Lane deviation_rate(int i, double flexibility) const { return r[i] - flexibility * g_[1][i] * speed_; }

  /// Moves every lane to a separate distance; move_back() reverses this.
  void move_lanes(Lane to) {
    const Lane step = (to - s) / parts_, part = step / speed_;
    for (int i = 0; i < modes_; ++i) {
      q_stored_[i] = q[i];
      r_stored_[i] = r[i];
      a_stored_[i] = a[i];
      const Advance by = advance_by(i, part, series_[i].terms);
      const double* c = task_.coefficients + 4 * task_.channels * interval + i;
      const double c0 = c[0], c1 = c[task_.channels], c2 = c[2 * task_.channels], c3 = c[3 * task_.channels];
      Lane d = fill(s - task_.start[interval]);
      for (double k = 1.0; k <= parts_; k += 1.0) {
        move(i, by, c1 + d * (2.0 * c2 + 3.0 * d * c3), c2 + 3.0 * d * c3, c3);
        d += step;
        a[i] = c0 + d * (c1 + d * (c2 + d * c3)) - task_.omega2[i] * q[i] - task_.damping[i] * r[i];
      }
    }
  }
  void move_back() {
    for (int i = 0; i < modes_; ++i) {
      q[i] = q_stored_[i];
      r[i] = r_stored_[i];
      a[i] = a_stored_[i];
    }
  }

  double s = 0.0;                                 // m travelled
  long interval = 0;                              // index of the interval between two events
  Lane *q = nullptr, *r = nullptr, *a = nullptr;  // coordinates, rates and accelerations of the modes

 private:
  static constexpr double most_phase =
      2.0;  // largest phase of a part of a sampling interval: up to this phase series are short
  static constexpr double most_long_phase = 8.0;  // of a part of a move of the windows
  static constexpr int most_terms = 48;           // limit of terms of a series
  static constexpr double last_term = 1e-19;      // last term of a series over its first term

  /// The coefficients of q', q'', j and the second and third powers of the distance in g, with which one step changes a
  /// mode's q and q'.
  struct Advance {
    Lane time, impulse, Q0, Q1, q_by_2, q_by_3, rate_by_2, rate_by_3;
  };
  struct Series {
    int terms, long_terms;                      // in a sampling interval, and in a move of the windows
    double by_2[most_terms], by_3[most_terms];  // coefficients of Q_2 and Q_3
  };

  /// Computes the series' coefficients for the longest part of a sampling interval, and the number of parts.
  void set_series() {
    double fastest = 0.0;
    for (int i = 0; i < modes_; ++i)
      if (rate_of(i) > fastest) fastest = rate_of(i);
    parts_ = __builtin_ceil(fastest * task_.instant / most_phase);
    long_phase_per_metre_ = fastest / task_.least_speed;
    for (int i = 0; i < modes_; ++i) {
      Series& own = series_[i];
      own.terms = terms_for(rate_of(i) * task_.instant / parts_);
      own.long_terms = terms_for(most_long_phase * rate_of(i) / fastest);
      double before = 0.0, impulse = 1.0;  // derivatives of O at t = 0
      double by_2 = 1.0 / 24.0, by_3 = 1.0 / 120.0;
      for (int k = 0; k < most_terms; ++k) {
        own.by_2[k] = impulse * by_2;
        own.by_3[k] = impulse * by_3;
        by_2 /= k + 5.0;
        by_3 /= k + 6.0;
        const double next = -task_.damping[i] * impulse - task_.omega2[i] * before;
        before = impulse;
        impulse = next;
      }
    }
  }

  /// The number of terms of a series up to this phase.
  static int terms_for(double phase) {
    double size = 1.0;
    int terms = 0;
    for (; terms < most_terms && (terms < 2 || size > last_term); ++terms)
      size *= phase / (terms + 5.0) * (terms + 2.0) / (terms + 1.0);
    return terms;
  }

  /// The number of parts of a move of the windows.
  double long_parts(double length) const {
    const double parts = __builtin_ceil(length * long_phase_per_metre_ / most_long_phase);
    return parts > 1.0 ? parts : 1.0;
  }

  /// The rate of a mode's fastest change, 1/s.
  double rate_of(int i) const {
    const double sigma = 0.5 * task_.damping[i], square = sigma * sigma - task_.omega2[i];
    return square > 0.0 ? sigma + __builtin_sqrt(square) : __builtin_sqrt(task_.omega2[i]);
  }

  Advance advance_by(int i, Lane time, int terms) const {
    const Series& own = series_[i];
    Lane Q2{}, Q3{};
    for (int k = terms - 1; k >= 0; --k) {
      Q2 = Q2 * time + own.by_2[k];
      Q3 = Q3 * time + own.by_3[k];
    }
    const Lane square = time * time;
    Q2 *= square * square;
    Q3 *= square * square * time;
    const double c = task_.damping[i], w = task_.omega2[i];
    const Lane Q1 = time * square * (1.0 / 6.0) - c * Q2 - w * Q3;
    const Lane Q0 = 0.5 * square - c * Q1 - w * Q2;
    const Lane impulse = time - c * Q0 - w * Q1;
    const Lane by_2 = 2.0 * speed_ * speed_, by_3 = 3.0 * by_2 * speed_;
    return {time, impulse, Q0, Q1, by_2 * Q2, by_3 * Q3, by_2 * Q1, by_3 * Q2};
  }

  /// One step of a mode; first, second, third: coefficients of the powers of the distance in g at its start, for all
  /// lanes or one lane.
  template <class Number>
  void move(int i, const Advance& by, Number first, Number second, double third) {
    const Lane rate = r[i], acceleration = a[i], jerk = first * speed_ - task_.omega2[i] * rate;
    q[i] = q[i] + (by.time * rate + (by.Q1 * jerk + (by.q_by_2 * second + by.q_by_3 * third))) + by.Q0 * acceleration;
    r[i] = rate + (by.Q0 * jerk + (by.rate_by_2 * second + by.rate_by_3 * third)) + by.impulse * acceleration;
  }

  /// A move from the start of an interval, where the coefficients of the forces are those of the interval.
  void move_from_start(const Advance* by) {
    const double* c = task_.coefficients + 4 * task_.channels * interval;
    for (int i = 0; i < modes_; ++i, ++c) {
      a[i] = c[0] - task_.omega2[i] * q[i] - task_.damping[i] * r[i];
      move(i, by[i], c[task_.channels], c[2 * task_.channels], c[3 * task_.channels]);
    }
  }
  void move_in_parts(int length, double to) {
    const double from = s, parts = length < 0 ? long_parts(to - from) : parts_of_length_[length];
    const Lane part = fill((to - from) / parts) / speed_;
    for (double k = 1.0; k <= parts; k += 1.0) {
      place(s);
      for (int i = 0; i < modes_; ++i)
        move(i, length < 0 ? advance_by(i, part, series_[i].long_terms) : by_length_[length * modes_ + i], g_[1][i],
             g_[2][i], g_[3][i]);
      s = part_of(from, to, k, parts);
    }
  }

  /// The end of the k-th part of a step.
  static double part_of(double from, double to, double k, double parts) {
    return k < parts ? from + (to - from) * (k / parts) : to;
  }

  /// Sets the distance, within this interval: modal forces and accelerations.
  void place(double at) {
    s = at;
    const double d = s - task_.start[interval];
    const double* c = task_.coefficients + 4 * task_.channels * interval;
    for (int i = 0; i < modes_; ++i) {
      const double c1 = c[task_.channels + i], c2 = c[2 * task_.channels + i], c3 = c[3 * task_.channels + i];
      const double force = c[i] + d * (c1 + d * (c2 + d * c3));
      g_[0][i] = force;
      g_[1][i] = c1 + d * (2.0 * c2 + 3.0 * d * c3);
      g_[2][i] = c2 + 3.0 * d * c3;
      g_[3][i] = c3;
      a[i] = force - task_.omega2[i] * q[i] - task_.damping[i] * r[i];
    }
  }

  const ForceTask& task_;
  const int modes_;
  Lane speed_{};
  double parts_ = 1.0;                 // number of parts of the longest sampling interval
  double long_phase_per_metre_ = 0.0;  // largest phase of the fastest mode in any lane
  Lane *q_stored_ = nullptr, *r_stored_ = nullptr, *a_stored_ = nullptr;
  double step_ = -1.0;            // m: sampling interval
  Advance* regular_ = nullptr;    // for one sampling interval
  Advance* by_length_ = nullptr;  // for a part of a move of each length: [length][mode]
  double* parts_of_length_ = nullptr;
  Series* series_ = nullptr;
  double* g_[4] = {};  // coefficients of g of the modes, by powers of the distance from the present position
};

}  // namespace
}  // namespace traverse::modal_engine
