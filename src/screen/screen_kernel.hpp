// A formation over a bridge at several speeds, one in each SIMD lane. All lanes share the events: the places at which
// an axle passes a support. Between two events the modes' coordinates are the particular solution under the axles on
// the bridge, plus free oscillations Re(Z), whose amplitudes |Z| can only decay. This gives a bound for each interval,
// from numbers at its start; only intervals with a bound above the interest of some lane are sampled.
#pragma once

#include "screen/bridge_numbers.hpp"
#include "screen/lane_functions.hpp"
#include "screen/screen_task.hpp"

namespace traverse::screen {
namespace {

using engine::allocate_from;

template <int W>
class ScreenBatch : LaneFunctions<W> {
  using Own = LaneFunctions<W>;
  using Own::any;
  using Own::exponential;
  using Own::fill;
  using Own::greater;
  using Own::lanes;
  using Own::magnitude;
  using Own::numbers;
  using Own::root;
  using Own::turn;
  using typename Own::Lane;
  using typename Own::Mask;

 public:
  ScreenBatch(const ScreenTask& task, double* work) : task_(task), modes_(task.modes) {
    Lane** const of_modes[] = {&z_real_,     &z_imag_,  &step_real_, &step_imag_,    &acceleration_,
                               &deflection_, &at_real_, &at_imag_,   &largest_real_, &largest_imag_};
    for (Lane** own : of_modes) *own = allocate_from<Lane>(work, used_, W, modes_);
    Lane** const of_gaps[] = {&gap_real_, &gap_imag_};
    for (Lane** own : of_gaps) *own = allocate_from<Lane>(work, used_, W, static_cast<long>(modes_) * task.gaps);
    reach_ = allocate_from<Lane>(work, used_, W, task.events);
    largest_ = allocate_from<Largest>(work, used_, W, 1);
    wave_ = allocate_from<double>(work, used_, W, 8L * modes_);
    copy_ = allocate_from<double>(work, used_, W, 2L * modes_);
  }
  long size() const { return used_ * W; }

  /// The largest bound of all intervals.
  void bound() {
    begin();
    Lane largest = Lane{};
    for (long i = 0; i < task_.events; ++i) {
      pass_event(i);
      if (is_interval(i)) largest = bound_above(i, largest);
    }
    *lanes(task_.result) = largest * (1.0 + rounding);
  }

  /// The largest fraction of a limit in the intervals with a bound above `limit` and the largest one so far, at the
  /// stations' samples. Then with task.search the largest one between them, in the intervals whose samples permit it.
  void pass() {
    begin();
    best_ = *lanes(task_.limit);
    task_.search ? search_at_largest() : forget_largest();
    for (long i = 0; i < task_.events; ++i) {
      pass_event(i);
      if (!is_interval(i)) continue;
      if (i + 1 == task_.events) break;
      if (task_.search) {
        if (exceeds(reach_[i], best_)) search(i, task_.length[i], reach_[i]);
        continue;
      }
      reach_[i] = Lane{};
      if (task_.every || exceeds(bound_above(i, best_), best_)) sample(i, task_.length[i]);
    }
    decay_freely();
    *lanes(task_.result) = best_;
  }

 private:
  static constexpr double rounding = 1e-9;     // of the bound
  static constexpr double most_samples = 1e7;  // of an interval
  static constexpr int longest_tail = 40;      // periods of the first mode that are sampled behind the train

  static bool exceeds(Lane a, Lane b) { return Own::exceeds(a, b) != 0; }
  Lane number(int mode, int row) const {
    return lanes(task_.numbers)[static_cast<long>(mode) * task_.numbers_of_mode + row];
  }
  const double* sums(long event, int mode) const { return task_.sums + (event * modes_ + mode) * sums_of_mode; }
  bool is_interval(long i) const { return i + 1 == task_.events || task_.gap[i] >= 0; }

  void begin() {
    for (int n = 0; n < modes_; ++n) {
      z_real_[n] = z_imag_[n] = Lane{};
      for (int g = 0; g < task_.gaps; ++g) {
        const Lane length = fill(task_.gap_length[g]), fall = exponential(-number(n, decay) * length);
        const auto [cosine, sine] = turn(number(n, Coefficient::turn) * length);
        gap_real_[n * task_.gaps + g] = fall * cosine;
        gap_imag_[n * task_.gaps + g] = fall * sine;
      }
    }
  }

  static void multiply(Lane& real, Lane& imag, Lane by_real, Lane by_imag) {
    const Lane product = real * by_real - imag * by_imag;
    imag = real * by_imag + imag * by_real;
    real = product;
  }

  /// Advances the free oscillations from the event before, and adds that of event i.
  void pass_event(long i) {
    const int gap = i > 0 ? task_.gap[i - 1] : -1, row = coefficients + 2 * task_.support[i];
    const Lane load = fill(task_.load[i]);
    for (int n = 0; n < modes_; ++n) {
      if (gap >= 0) multiply(z_real_[n], z_imag_[n], gap_real_[n * task_.gaps + gap], gap_imag_[n * task_.gaps + gap]);
      z_real_[n] += load * number(n, row);
      z_imag_[n] += load * number(n, row + 1);
    }
  }

  // --- bound -------------------------------------------------------------------------------------------------------

  /// The greater of `least` and the bound of the fractions of the limits in the interval after event i.
  Lane bound_above(long i, Lane least) {
    Lane coarse_acceleration = Lane{}, coarse_deflection = Lane{};
    for (int n = 0; n < modes_; ++n) {
      const double* s = sums(i, n);
      const Lane free = root(z_real_[n] * z_real_[n] + z_imag_[n] * z_imag_[n]);
      const Lane falling = number(n, falling_gain), rising = number(n, rising_gain);
      Lane forced = s[0] * magnitude(number(n, real_gain)) + s[1] * magnitude(number(n, imag_gain));
      if (task_.continuous) forced += 0.5 * (s[2] * (falling + rising) + s[3] * magnitude(falling - rising));
      acceleration_[n] = task_.omega2[n] * free + number(n, omega2_drive) * forced;
      deflection_[n] = free + forced;
      coarse_acceleration += task_.largest[n] * acceleration_[n];
      coarse_deflection += task_.largest[n] * deflection_[n];
    }
    return largest_of({task_.different_parts, task_.magnitudes, task_.of_magnitudes}, coarse_acceleration,
                      coarse_deflection, least);
  }

  struct Places {
    int count;
    const double *shapes, *of_deflection;
  };

  /// The greater of `least` and the largest fraction of a limit at these places, by acceleration_ and deflection_ of
  /// the modes. coarse: bounds of both at all places.
  Lane largest_of(const Places& places, Lane coarse_acceleration, Lane coarse_deflection, Lane least) const {
    if (exceeds(task_.of_acceleration * coarse_acceleration, least)) {
      Lane largest = Lane{};
      for (int s = 0; s < places.count; ++s)
        largest = greater(largest, magnitude(response(places.shapes + s * modes_, acceleration_)));
      least = greater(least, task_.of_acceleration * largest);
    }
    if (exceeds(task_.largest_of_deflection * coarse_deflection, least))
      for (int s = 0; s < places.count; ++s)
        least = greater(least, places.of_deflection[s] * magnitude(response(places.shapes + s * modes_, deflection_)));
    return least;
  }

  Lane response(const double* shape, const Lane* of_modes) const {
    Lane sum = Lane{};
    for (int n = 0; n < modes_; ++n) sum += shape[n] * of_modes[n];
    return sum;
  }

  // --- samples -----------------------------------------------------------------------------------------------------

  int parts_of(double length) const {
    const double wanted = length / task_.spacing;
    return 1 + static_cast<int>(wanted < most_samples ? wanted : most_samples);
  }

  /// Samples the interval after event i, from its start to its end.
  void sample(long i, double length) {
    const int parts = parts_of(length);
    const double step = length / parts;
    const Lane error = excess(i, step);
    begin_samples(i, step);
    Lane top = greater(Lane{}, (best_ - error) * (1.0 - rounding));  // samples below cannot belong to a larger peak
    for (int k = 0; k <= parts; ++k) {
      if (k > 0) advance();
      top = response_above(top);
    }
    ++*task_.sampled;
    reach_[i] = top + error;
    if (!exceeds(top, best_)) return;
    const Mask larger = top > best_;
    best_ = greater(best_, top);
    largest_->event = larger ? fill(static_cast<double>(i)) : largest_->event;
    largest_->length = larger ? fill(length) : largest_->length;
    largest_->error = larger ? error : largest_->error;
    for (int n = 0; n < modes_; ++n) {
      largest_real_[n] = larger ? z_real_[n] : largest_real_[n];
      largest_imag_[n] = larger ? z_imag_[n] : largest_imag_[n];
    }
  }

  void forget_largest() { largest_->event = fill(-1.0); }

  /// The exact peaks in the intervals with the largest samples: below them nothing else needs a search.
  void search_at_largest() {
    for (int lane = 0; lane < W; ++lane)
      if (const double event = numbers(largest_->event)[lane]; event >= 0.0)
        search_lane(lane, static_cast<long>(event), largest_real_, largest_imag_, numbers(largest_->length)[lane],
                    numbers(largest_->error)[lane]);
  }

  void begin_samples(long i, double step) {
    const Lane length = fill(step);
    for (int n = 0; n < modes_; ++n) {
      const Lane fall = exponential(-number(n, decay) * length);
      const auto [cosine, sine] = turn(number(n, Coefficient::turn) * length);
      step_real_[n] = fall * cosine;
      step_imag_[n] = fall * sine;
      at_real_[n] = z_real_[n];
      at_imag_[n] = z_imag_[n];
      double* wave = wave_ + 8 * n;
      const double angle = task_.beta[n] * step;
      for (int k = 0; k < 4; ++k) wave[k] = sums(i, n)[4 + k];
      wave[4] = __builtin_cos(angle);
      wave[5] = __builtin_sin(angle);
      wave[6] = task_.continuous ? __builtin_exp(-angle) : 1.0;
      wave[7] = task_.continuous ? __builtin_exp(angle) : 1.0;
    }
  }

  void advance() {
    for (int n = 0; n < modes_; ++n) {
      multiply(at_real_[n], at_imag_[n], step_real_[n], step_imag_[n]);
      double* wave = wave_ + 8 * n;
      const double real = wave[0] * wave[4] - wave[1] * wave[5];
      wave[1] = wave[0] * wave[5] + wave[1] * wave[4];
      wave[0] = real;
      wave[2] *= wave[6];
      wave[3] *= wave[7];
    }
  }

  /// The greater of `least` and the largest fraction of a limit at all stations.
  Lane response_above(Lane least) {
    Lane coarse_acceleration = Lane{}, coarse_deflection = Lane{};
    for (int n = 0; n < modes_; ++n) {
      const double* wave = wave_ + 8 * n;
      const Lane harmonic = wave[0] * number(n, real_gain) - wave[1] * number(n, imag_gain);
      Lane ends = Lane{};
      if (task_.continuous) ends = wave[2] * number(n, falling_gain) + wave[3] * number(n, rising_gain);
      acceleration_[n] = task_.lambda2[2 * n] * at_real_[n] - task_.lambda2[2 * n + 1] * at_imag_[n] +
                         number(n, omega2_drive) * (ends - harmonic);
      deflection_[n] = at_real_[n] + harmonic + ends;
      coarse_acceleration += task_.largest[n] * magnitude(acceleration_[n]);
      coarse_deflection += task_.largest[n] * magnitude(deflection_[n]);
    }
    return largest_of({task_.stations, task_.shapes, task_.of_deflection}, coarse_acceleration, coarse_deflection,
                      least);
  }

  /// A bound of the amount by which a peak in time and along the bridge exceeds the nearest of the stations' samples,
  /// `step` m of the way apart. At the peak both first derivatives are zero. A motion that turns by the angle a from
  /// sample to sample, with a shape that turns by b from station to station, changes by at most (a + b)^2/8 of its
  /// amplitude.
  Lane excess(long i, double step) {
    const Lane time = fill(step) / *lanes(task_.speed);
    Lane of_acceleration = Lane{}, of_deflection = Lane{};
    for (int n = 0; n < modes_; ++n) {
      const double* s = sums(i, n);
      const Lane free = root(z_real_[n] * z_real_[n] + z_imag_[n] * z_imag_[n]);
      const Lane forced = s[1] * (magnitude(number(n, real_gain)) + magnitude(number(n, imag_gain))) +
                          s[3] * greater(number(n, falling_gain), number(n, rising_gain));
      const Lane turned = task_.beta[n] * task_.part + time * __builtin_sqrt(task_.omega2[n]);
      const double driven = task_.beta[n] * (task_.part + step);
      const Lane of_free = turned * turned * free, of_forced = driven * driven * forced;
      of_deflection += task_.size[n] * (of_free + of_forced);
      of_acceleration += task_.size[n] * (task_.omega2[n] * of_free + number(n, omega2_drive) * of_forced);
    }
    return 0.125 * greater(task_.of_acceleration * of_acceleration, task_.largest_of_deflection * of_deflection);
  }

  /// The exact peaks in the interval after event i of the lanes in which one may exceed the largest value so far: those
  /// whose `reach`, the largest sample plus its possible error, does.
  void search(long i, double length, Lane reach) {
    Lane error = excess(i, length / parts_of(length));
    for (int lane = 0; lane < W; ++lane)
      if (numbers(reach)[lane] > numbers(best_)[lane])
        search_lane(lane, i, z_real_, z_imag_, length, numbers(error)[lane]);
  }

  void search_lane(int lane, long i, Lane* z_real, Lane* z_imag, double length, double error) {
    for (int n = 0; n < modes_; ++n) {
      copy_[2 * n] = numbers(z_real[n])[lane];
      copy_[2 * n + 1] = numbers(z_imag[n])[lane];
    }
    double& best = numbers(best_)[lane];
    best = task_.search_peak(task_.context, lane, i, copy_, length, parts_of(length), error, best);
  }

  /// The free oscillation after the last event, part by part while its bound is above the largest value so far. If that
  /// never ends, the bound counts.
  void decay_freely() {
    const long last = task_.events - 1;
    for (int part = 0; part < longest_tail; ++part) {
      if (!exceeds(bound_above(last, best_), best_)) return;
      sample(last, task_.tail);
      if (task_.search) search(last, task_.tail, reach_[last]);
      for (int n = 0; n < modes_; ++n) {
        z_real_[n] = at_real_[n];
        z_imag_[n] = at_imag_[n];
      }
    }
    best_ = bound_above(last, best_);
  }

  const ScreenTask& task_;
  const int modes_;
  long used_ = 0;
  Lane *z_real_ = nullptr, *z_imag_ = nullptr;            // Z of each mode at the last event
  Lane *at_real_ = nullptr, *at_imag_ = nullptr;          // Z at a sample
  Lane *step_real_ = nullptr, *step_imag_ = nullptr;      // the factor of Z from sample to sample
  Lane *gap_real_ = nullptr, *gap_imag_ = nullptr;        // the factor of Z over each gap: [mode][gap]
  Lane *acceleration_ = nullptr, *deflection_ = nullptr;  // of each mode: q'' and q, or their bounds
  struct Largest {                                        // the interval with the largest sample of each lane
    Lane event, length, error;
  };
  Largest* largest_ = nullptr;
  Lane *largest_real_ = nullptr, *largest_imag_ = nullptr;  // Z of each mode at its start
  Lane* reach_ = nullptr;                                   // of each event: no peak of the interval after it is larger
  double* wave_ = nullptr;  // of each mode: the sums at a sample, and their factors from sample to sample
  double* copy_ = nullptr;
  Lane best_ = Lane{};
};

}  // namespace
}  // namespace traverse::screen
