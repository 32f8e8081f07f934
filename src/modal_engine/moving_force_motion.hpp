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
    series_ = allocate_from<Series>(work, used, W, modes_);
    for (double*& power : g_) power = allocate_from<double>(work, used, W, modes_);
  }

  void begin() {
    speed_ = *Own::lanes(task_.speed);
    set_series();
    for (int k = 0; k < task_.lengths; ++k)
      for (int i = 0; i < modes_; ++i)
        by_length_[k * modes_ + i] = advance_by(i, fill(task_.length[k]) / speed_, task_.length[k] / task_.least_speed);
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
    for (int i = 0; i < modes_; ++i) regular_[i] = advance_by(i, fill(step) / speed_, task_.instant);
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
    for (int i = 0; i < modes_; ++i) move(i, regular_[i], g_[1][i], g_[2][i], g_[3][i]);
    place(to);
  }

  /// Moves to a distance at most one sampling interval away, not beyond the next event.
  void move_to(double to) {
    move_all(to, task_.instant);
    place(to);
  }

  /// Makes one move of the windows, up to the distance `to` in the same interval; place_again() follows after the last.
  void make_move(long number, double to) {
    const int length = task_.move_length[number];
    if (length >= 0 && s == task_.start[interval]) {
      move_from_start(by_length_ + length * modes_);
    } else {
      place(s);
      move_all(to, (to - s) / task_.least_speed);
    }
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
    const Lane step = to - s, time = step / speed_, d = step + (s - task_.start[interval]);
    const double begin = s - task_.start[interval];
    for (int i = 0; i < modes_; ++i) {
      q_stored_[i] = q[i];
      r_stored_[i] = r[i];
      a_stored_[i] = a[i];
      const double* c = task_.coefficients + 4 * task_.channels * interval + i;
      const double c0 = c[0], c1 = c[task_.channels], c2 = c[2 * task_.channels], c3 = c[3 * task_.channels];
      move(i, advance_by(i, time, task_.instant), c1 + begin * (2.0 * c2 + 3.0 * begin * c3), c2 + 3.0 * begin * c3,
           c3);
      a[i] = c0 + d * (c1 + d * (c2 + d * c3)) - task_.omega2[i] * q[i] - task_.damping[i] * r[i];
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
  static constexpr double most_phase = 2.0;   // largest phase of a series: up to this phase series are short
  static constexpr int most_terms = 28;       // limit of terms of a series
  static constexpr double last_term = 1e-19;  // last term of a series over its first term

  /// The coefficients of q', q'', j and the second and third powers of the distance in g, with which one step changes a
  /// mode's q and q'.
  struct Advance {
    Lane time, impulse, Q0, Q1, q_by_2, q_by_3, rate_by_2, rate_by_3;
  };
  struct Series {
    double rate;                                // of the mode's fastest change, 1/s
    int terms, long_terms;                      // in a sampling interval, and in any part
    double by_2[most_terms], by_3[most_terms];  // coefficients of Q_2 and Q_3
  };

  /// Computes the series' coefficients.
  void set_series() {
    for (int i = 0; i < modes_; ++i) {
      Series& own = series_[i];
      own.rate = rate_of(i);
      own.terms = terms_for(own.rate * task_.instant);
      own.long_terms = terms_for(most_phase);
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

  /// The number of terms of a series up to this phase, at most most_phase.
  static int terms_for(double phase) {
    phase = phase < most_phase ? phase : most_phase;
    double size = 1.0;
    int terms = 0;
    for (; terms < most_terms && (terms < 2 || size > last_term); ++terms)
      size *= phase / (terms + 5.0) * (terms + 2.0) / (terms + 1.0);
    return terms;
  }

  /// The rate of a mode's fastest change, 1/s.
  double rate_of(int i) const {
    const double sigma = 0.5 * task_.damping[i], square = sigma * sigma - task_.omega2[i];
    return square > 0.0 ? sigma + __builtin_sqrt(square) : __builtin_sqrt(task_.omega2[i]);
  }

  /// The step of a mode in a time, which is at most `longest` in any lane, s: by series for a power of two of its
  /// parts, and from each part to twice this part by superposition.
  Advance advance_by(int i, Lane time, double longest) const {
    const Series& own = series_[i];
    const double c = task_.damping[i], w = task_.omega2[i];
    double share = 1.0;  // of a part in the time
    int doublings = 0;
    for (; own.rate * longest * share > most_phase; share *= 0.5) ++doublings;
    Lane t = time * share, Q2{}, Q3{};
    const int terms = longest <= task_.instant ? own.terms : own.long_terms;
    for (int k = terms - 1; k >= 0; --k) {
      Q2 = Q2 * t + own.by_2[k];
      Q3 = Q3 * t + own.by_3[k];
    }
    const Lane square = t * t;
    Q2 *= square * square;
    Q3 *= square * square * t;
    Lane Q1 = t * square * (1.0 / 6.0) - c * Q2 - w * Q3;
    Lane Q0 = 0.5 * square - c * Q1 - w * Q2;
    Lane impulse = t - c * Q0 - w * Q1;
    for (; doublings > 0; --doublings) {
      const Lane free = 1.0 - w * Q0, rate = free - c * impulse;  // after a unit displacement; of the impulse response
      Q3 = Q3 * free + Q2 * impulse + Q3 + t * (Q2 + t * (0.5 * Q1 + t * (1.0 / 6.0) * Q0));
      Q2 = Q2 * free + Q1 * impulse + Q2 + t * (Q1 + 0.5 * t * Q0);
      Q1 = Q1 * free + Q0 * impulse + Q1 + t * Q0;
      Q0 = Q0 * free + impulse * impulse + Q0;
      impulse = impulse * (free + rate);
      t += t;
    }
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
  /// Moves all lanes to this distance, in at most this time (s) in any lane.
  void move_all(double to, double longest) {
    const Lane time = fill(to - s) / speed_;
    for (int i = 0; i < modes_; ++i) move(i, advance_by(i, time, longest), g_[1][i], g_[2][i], g_[3][i]);
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
  Lane *q_stored_ = nullptr, *r_stored_ = nullptr, *a_stored_ = nullptr;
  double step_ = -1.0;            // m: sampling interval
  Advance* regular_ = nullptr;    // for one sampling interval
  Advance* by_length_ = nullptr;  // for a move of each length: [length][mode]
  Series* series_ = nullptr;
  double* g_[4] = {};  // coefficients of g of the modes, by powers of the distance from the present position
};

}  // namespace
}  // namespace traverse::modal_engine
