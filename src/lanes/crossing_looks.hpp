// What is seen of the crossing of a group of trains: peaks at the probes, extremes of wheel forces
// (crossing_kernel.hpp).
#pragma once

#include "lanes/crossing_contacts.hpp"
#include "lanes/crossing_left_out.hpp"

namespace traverse::lanes {
namespace {

template <int W>
struct CrossingLooks : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using State = CrossingState<W>;
  using Own::any;
  using Own::fill;
  using Own::holds;
  using Own::lanes;
  using Own::magnitude;
  using Own::numbers;
  using typename Own::Lane;
  using typename Own::Mask;

  static constexpr double near = 0.9;   // of the largest magnitude so far: no parabola's vertex of less is larger
  static constexpr double alike = 4.0;  // see WheelExtremes
  static constexpr int bisections = 30;

  /// The responses of the probes, and whether the motion is finite.
  static void see(State& s) {
    see_probes(s);
    Lane sum{};
    for (int i = 0; i < s.modes; ++i) sum += s.q[i];
    s.failed = sum - sum == Lane{} ? s.failed : fill(not_finite);
  }

  /// That, and the peaks so far.
  static void look(State& s, bool moved) {
    const Lane time = s.distance / s.speed;
    const Mask counts = time <= s.end_time * (1.0 + 1e-12);
    s.time[0] = s.time[1];
    s.time[1] = s.time[2];
    s.time[2] = time;
    ++s.known;
    ++s.looks;
    see(s);
    look_at_probes(s, counts);
    if (moved) look_at_wheels(s, counts);
  }

  static void see_probes(State& s) {
    const int n = s.task.probes.count, count = 4 * n;
    Lane* const oldest = s.row_of[0];
    s.row_of[0] = s.row_of[1];
    s.row_of[1] = s.row_of[2];
    s.row_of[2] = oldest;
    Lane* seen = s.row_of[2];
    for (int i = 0; i < count; ++i) seen[i] = Lane{};
    CrossingLeftOut<W>::add(s, seen);
    for (int i = 0; i < s.modes; ++i) {
      const Lane q = s.q[i], r = s.r[i], a = s.b[0][i];
      const double *deflection = s.task.probes.deflection + static_cast<long>(i) * n,
                   *moment = s.task.probes.moment + static_cast<long>(i) * n,
                   *by_rate = s.task.probes.moment_by_rate + static_cast<long>(i) * n,
                   *by_acceleration = s.task.probes.moment_by_acceleration + static_cast<long>(i) * n;
      for (int p = 0; p < n; ++p) {
        seen[p] += deflection[p] * q;
        seen[n + p] += deflection[p] * a;
        seen[2 * n + p] += moment[p] * q + by_rate[p] * r + by_acceleration[p] * a;
        seen[3 * n + p] += moment[p] * r + by_rate[p] * a;
      }
      if (s.task.probes.deflection_by_rate == nullptr) continue;
      for (int p = 0; p < n; ++p) seen[p] += s.task.probes.deflection_by_rate[static_cast<long>(i) * n + p] * r;
    }
  }

  static void look_at_probes(State& s, Mask counts) {
    const int n = s.task.probes.count, count = 3 * n;
    for (int i = 0; i < count; ++i) {
      const Lane value = magnitude(s.row_of[2][i]);
      const Mask larger = counts & (value > s.peak[i]);
      s.peak[i] = larger ? value : s.peak[i];
      s.peak_time[i] = larger ? s.time[2] : s.peak_time[i];
      if (i >= 2 * n && s.task.left_out.lag > 0.0) {
        if (s.looks >= 2) look_at_lagging(s, i, counts);
        continue;
      }
      if ((i < 2 * n ? s.looks : s.known) < 3) continue;
      const Lane middle = magnitude(s.row_of[1][i]);
      const Mask turns = counts & (middle > near * s.peak[i]) & (middle > value);
      if (any(turns)) look_between(s, i, turns);
    }
  }

  /// The vertex of the parabola through the last three instants, of whose magnitudes the middle one is the largest.
  static void look_between(State& s, int i, Mask turns) {
    const Lane sign = s.row_of[1][i] < Lane{} ? fill(-1.0) : fill(1.0);
    const Lane y0 = sign * s.row_of[0][i], y1 = sign * s.row_of[1][i], y2 = sign * s.row_of[2][i];
    turns &= y1 >= y0;
    const Lane before = (y1 - y0) / (s.time[1] - s.time[0]), after = (y2 - y1) / (s.time[2] - s.time[1]);
    const Lane bend = (after - before) / (s.time[2] - s.time[0]);
    const Lane at = 0.5 * (s.time[0] + s.time[1]) - 0.5 * before / bend;
    const Lane top = y1 + (at - s.time[1]) * (before + bend * (at - s.time[0]));
    turns &= top > s.peak[i];
    s.peak[i] = turns ? top : s.peak[i];
    s.peak_time[i] = turns ? at : s.peak_time[i];
  }

  /// Between the last two instants a moment that lags is start + p t + q t^2 + k b (exp(-t/b) - 1), with both values
  /// and both rates, as app::RelaxingCurve has it.
  static void look_at_lagging(State& s, int i, Mask counts) {
    const int rate = i + s.task.probes.count;
    const Lane start = s.row_of[1][i], rising = s.row_of[1][rate], falling = s.row_of[2][rate];
    const Mask turns = counts & (rising * falling < Lane{}) & (rising * start > Lane{}) &
                       (Own::greater(magnitude(start), magnitude(s.row_of[2][i])) > near * s.peak[i]);
    if (!any(turns)) return;
    const Lane h = s.time[2] - s.time[1];
    for (int l = 0; l < W; ++l) {
      if (!holds(turns, l)) continue;
      const double step = numbers(h)[l], lag = s.task.left_out.lag < 100.0 * step ? s.task.left_out.lag : 100.0 * step;
      const double decay = __builtin_exp(-step / lag), decayed = 1.0 - decay;
      const double first = numbers(start)[l], before = numbers(rising)[l], after = numbers(falling)[l];
      const double k = (numbers(s.row_of[2][i])[l] - first - 0.5 * step * (before + after)) /
                       (0.5 * step * (1.0 + decay) - lag * decayed);
      const double p = before + k, q = 0.5 * (after - before - k * decayed) / step;
      double from = 0.0, to = step;
      for (int bisection = 0; bisection < bisections; ++bisection) {
        const double t = 0.5 * (from + to);
        ((p + 2.0 * q * t - k * __builtin_exp(-t / lag)) * before > 0.0 ? from : to) = t;
      }
      const double top = first + from * (p + q * from) - k * lag * (1.0 - __builtin_exp(-from / lag));
      const double size = top < 0.0 ? -top : top;
      if (size <= numbers(s.peak[i])[l]) continue;
      numbers(s.peak[i])[l] = size;
      numbers(s.peak_time[i])[l] = numbers(s.time[1])[l] + from;
    }
  }

  static void look_at_wheels(State& s, Mask counts) {
    Lane* const oldest = s.F_seen[0];
    for (int i = 0; i < 4; ++i) {
      s.s_seen[i] = s.s_seen[i + 1];
      s.F_seen[i] = s.F_seen[i + 1];
    }
    s.s_seen[4] = s.distance;
    s.F_seen[4] = oldest;
    ++s.seen;
    for (int j = 0; j < s.task.wheels; ++j) {
      const Lane force = CrossingContacts<W>::normal(s, j);
      s.F_seen[4][j] = force;
      s.least = counts & (force < s.least) ? force : s.least;
      s.greatest = counts & (force > s.greatest) ? force : s.greatest;
    }
    if (s.seen >= 4) look_at_turns(s, 2);
  }

  /// What forces of wheels were between steps where they turn at the instant i of the last five, as app::WheelExtremes
  /// has it. Distances take the place of times.
  static void look_at_turns(State& s, int i) {
    const double *at = s.s_seen, before = at[i] - at[i - 1], after = at[i + 1] - at[i];
    if (before > alike * after || after > alike * before) return;
    const bool five = i == 2 && s.seen >= 5 && alike_all(at);
    const Mask counts = at[i + 1] / s.speed <= s.end_time * (1.0 + 1e-12);
    for (int j = 0; j < s.task.wheels; ++j) {
      const Lane F = s.F_seen[i][j], rise = F - s.F_seen[i - 1][j], fall = s.F_seen[i + 1][j] - F;
      const Mask turns = counts & (rise * fall <= Lane{}) & (fall != Lane{});
      if (!any(turns) || !smooth(s, s.task.x[j], at[i - 1], at[i + 1])) continue;
      const Lane up = rise / before, down = fall / after;
      const Lane slope = (up * after + down * before) / (before + after), bend = (down - up) / (before + after);
      Lane top = F - 0.25 * slope * slope / bend;
      if (five && smooth(s, s.task.x[j], at[0], at[4])) top = turn_of_five(s, j, slope, bend, top);
      s.least = turns & (top < s.least) & (top > Lane{}) ? top : s.least;
      s.greatest = turns & (top > s.greatest) ? top : s.greatest;
    }
  }

  static bool alike_all(const double* at) {
    double shortest = at[1] - at[0], longest = shortest;
    for (int i = 1; i < 4; ++i) {
      const double gap = at[i + 1] - at[i];
      shortest = gap < shortest ? gap : shortest;
      longest = gap > longest ? gap : longest;
    }
    return longest <= alike * shortest;
  }

  /// app::turn_of_five of a wheel's force; otherwise: what counts where it was in flight.
  static Lane turn_of_five(State& s, int j, Lane slope, Lane bend, Lane otherwise) {
    constexpr int iterations = 3;
    const double *at = s.s_seen, s0 = at[0] - at[2], s1 = at[1] - at[2], s3 = at[3] - at[2], s4 = at[4] - at[2];
    const Lane y = s.F_seen[2][j];
    const auto missed = [&](double d, Lane F) { return (F - y - d * (slope + bend * d)) / ((d - s1) * d * (d - s3)); };
    const Lane c = missed(s0, s.F_seen[0][j]), fourth = (missed(s4, s.F_seen[4][j]) - c) / (s4 - s0);
    const Lane e = c - fourth * s0;
    const Lane first = slope + e * (s1 * s3), second = bend - e * (s1 + s3) + fourth * (s1 * s3),
               third = e - fourth * (s1 + s3);
    Lane d = -0.5 * slope / bend;
    for (int k = 0; k < iterations; ++k)
      d -= (first + d * (2.0 * second + d * (3.0 * third + d * 4.0 * fourth))) /
           (2.0 * second + d * (6.0 * third + d * 12.0 * fourth));
    Mask valid = (d >= s1) & (d <= s3);
    for (int i = 0; i < 5; ++i) valid &= s.F_seen[i][j] > Lane{};
    return valid ? y + d * (first + d * (second + d * (third + d * fourth))) : otherwise;
  }

  /// Whether a wheel has met no corner of the surface between two distances.
  static bool smooth(State& s, double x, double from, double to) {
    for (int i = 0; i < s.task.kinks; ++i)
      if (s.task.kink[i] >= x + from && s.task.kink[i] <= x + to) return false;
    return true;
  }

  /// Keeps the accelerations of the latest instant.
  static void keep(State& s) {
    const int n = s.task.probes.count;
    for (int p = 0; p < n; ++p) lanes(s.task.kept)[s.kept * n + p] = s.row_of[2][n + p];
    ++s.kept;
  }

  static void give(State& s) {
    if (s.seen >= 3) look_at_turns(s, 3);
    for (int i = 0; i < 3 * s.task.probes.count; ++i) {
      lanes(s.task.peak)[i] = s.peak[i];
      lanes(s.task.peak_time)[i] = s.peak_time[i];
    }
    *lanes(s.task.least_force) = s.least;
    *lanes(s.task.greatest_force) = s.greatest;
    *lanes(s.task.edge) = s.edge;
    for (int i = 0; i < s.task.coordinates; ++i) lanes(s.task.bent)[i] = s.bent[i];
    *lanes(s.task.failed) = s.failed;
  }
};

}  // namespace
}  // namespace traverse::lanes
