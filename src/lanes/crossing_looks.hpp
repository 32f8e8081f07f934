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

  static constexpr double near = 0.9;         // of the largest magnitude so far: nothing that turns below is larger
  static constexpr double most_uneven = 4.0;  // as in run/turn.hpp
  static constexpr int bisections = 30, most = 5, latest = most - 1;

  /// The responses of the probes, and whether the motion is finite.
  static void see(State& s) {
    see_probes(s);
    Lane sum{};
    for (int i = 0; i < s.modes; ++i) sum += s.q[i];
    s.failed = sum - sum == Lane{} ? s.failed : fill(not_finite);
  }

  /// That, and the peaks so far.
  static void look(State& s, bool moved) {
    const Mask counts = runs_until(s, s.distance);
    for (int i = 0; i < latest; ++i) s.s_seen[i] = s.s_seen[i + 1];
    s.s_seen[latest] = s.distance;
    ++s.known;
    ++s.looks;
    see(s);
    look_at_probes(s, counts);
    if (moved) look_at_wheels(s, counts);
  }
  /// After the last look, or before one with a kink: what turns just before it. Of the responses from `first` on.
  static void look_at_last(State& s, int first) {
    for (int i = first; i < 3 * s.task.probes.count; ++i) look_between(s, i, latest - 1);
  }
  static void look_before_kink(State& s) {
    look_at_last(s, 2 * s.task.probes.count);
    s.known = 1;
  }

  static Mask runs_until(const State& s, double distance) { return distance / s.speed <= s.end_time * (1.0 + 1e-12); }

  static void see_probes(State& s) {
    const int n = s.task.probes.count, count = 4 * n;
    Lane* seen = take_turns(s.row_of);
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

  /// The oldest of the rows, which becomes the latest one.
  static Lane* take_turns(Lane** rows) {
    Lane* const oldest = rows[0];
    for (int i = 0; i < latest; ++i) rows[i] = rows[i + 1];
    return rows[latest] = oldest;
  }

  static void look_at_probes(State& s, Mask counts) {
    const int n = s.task.probes.count, count = 3 * n;
    for (int i = 0; i < count; ++i) {
      const Lane value = magnitude(s.row_of[latest][i]);
      const Mask larger = counts & (value > s.peak[i]);
      s.peak[i] = larger ? value : s.peak[i];
      s.peak_time[i] = larger ? s.distance / s.speed : s.peak_time[i];
      if (i >= 2 * n && s.task.left_out.lag > 0.0) {
        if (s.looks >= 2) look_at_lagging(s, i, counts);
      } else {
        look_between(s, i, 2);
      }
    }
  }

  /// Which of the last five instants tell where a curve turns about the one at m: app::turn_about.
  struct Stencil {
    int left = 0, right = 0;
    bool three = false, five = false;

    /// seen: so many instants without a kink.
    Stencil(const double* at, int m, long seen) : left(m - 1), right(m + 1) {
      const int oldest = seen < most ? most - static_cast<int>(seen) : 0;
      if (left < oldest) return;
      const auto apart = [=](int a, int b) { return at[b] - at[a]; };
      five = m == 2 && oldest == 0 && alike(apart(0, 1), apart(1, 2)) && alike(apart(1, 2), apart(2, 3)) &&
             alike(apart(2, 3), apart(3, 4));
      while (left > oldest && most_uneven * apart(left, m) < apart(m, m + 1)) --left;
      while (right < latest && most_uneven * apart(m, right) < apart(m - 1, m)) ++right;
      three = alike(apart(left, m), apart(m, right));
    }
    static bool alike(double a, double b) { return a <= most_uneven * b && b <= most_uneven * a; }
  };

  /// The value where the curve of rows turns about the instant m, by three instants or five, and how far behind m that
  /// is: app::turn_of_five, lane by lane.
  static Lane turn(const double* at, Lane* const* rows, int i, int m, const Stencil& by, bool five, Lane& behind) {
    constexpr int iterations = 3;
    const int l = five ? m - 1 : by.left, r = five ? m + 1 : by.right;
    const double before = at[m] - at[l], after = at[r] - at[m];
    const Lane y = rows[m][i], up = (y - rows[l][i]) / before, down = (rows[r][i] - y) / after;
    const Lane slope = (up * after + down * before) / (before + after), bend = (down - up) / (before + after);
    behind = -0.5 * slope / bend;
    const Lane of_three = y + 0.5 * slope * behind;
    if (!five) return of_three;
    const double s0 = at[0] - at[2], s1 = -before, s3 = after, s4 = at[4] - at[2];
    const auto missed = [&](double d, Lane Y) { return (Y - y - d * (slope + bend * d)) / ((d - s1) * d * (d - s3)); };
    const Lane c = missed(s0, rows[0][i]), fourth = (missed(s4, rows[4][i]) - c) / (s4 - s0), e = c - fourth * s0;
    const Lane first = slope + e * (s1 * s3), second = bend - e * (s1 + s3) + fourth * (s1 * s3),
               third = e - fourth * (s1 + s3);
    Lane d = behind;
    for (int k = 0; k < iterations; ++k)
      d -= (first + d * (2.0 * second + d * (3.0 * third + d * 4.0 * fourth))) /
           (2.0 * second + d * (6.0 * third + d * 12.0 * fourth));
    const Mask inside = (d >= s1) & (d <= s3);
    behind = inside ? d : behind;
    return inside ? y + d * (first + d * (second + d * (third + d * fourth))) : of_three;
  }

  /// Response i, where its magnitude at the instant m is larger than those of its neighbours.
  static void look_between(State& s, int i, int m) {
    const bool is_moment = i >= 2 * s.task.probes.count;
    if (is_moment && s.task.left_out.lag > 0.0) return;
    const Lane middle = magnitude(s.row_of[m][i]);
    const Mask large = (middle > near * s.peak[i]) & (middle > magnitude(s.row_of[m + 1][i]));
    const double* at = s.s_seen;
    if (!any(large)) return;
    const Stencil by(at, m, is_moment ? s.known : s.looks);
    if (!by.three) return;
    const Lane before = s.row_of[by.left][i], after = s.row_of[by.right][i], y = s.row_of[m][i];
    const Mask turns = large & runs_until(s, at[m + 1]) & ((y - before) * (after - y) <= Lane{}) &
                       (middle >= magnitude(s.row_of[m - 1][i]));
    if (!any(turns)) return;
    Lane behind;
    const Lane top = magnitude(turn(at, s.row_of, i, m, by, by.five, behind));
    const Mask larger = turns & (top > s.peak[i]);
    s.peak[i] = larger ? top : s.peak[i];
    s.peak_time[i] = larger ? (at[m] + behind) / s.speed : s.peak_time[i];
  }

  /// Between the last two instants a moment that lags is start + p t + q t^2 + k b (exp(-t/b) - 1), with both values
  /// and both rates, as app::RelaxingCurve has it.
  static void look_at_lagging(State& s, int i, Mask counts) {
    const int rate = i + s.task.probes.count;
    const Lane *last = s.row_of[latest], *before_last = s.row_of[latest - 1];
    const Lane start = before_last[i], rising = before_last[rate], falling = last[rate];
    const Mask turns = counts & (rising * falling < Lane{}) & (rising * start > Lane{}) &
                       (Own::greater(magnitude(start), magnitude(last[i])) > near * s.peak[i]);
    if (!any(turns)) return;
    const Lane began = s.s_seen[latest - 1] / s.speed, h = s.distance / s.speed - began;
    for (int l = 0; l < W; ++l) {
      if (!holds(turns, l)) continue;
      const double step = numbers(h)[l], lag = s.task.left_out.lag < 100.0 * step ? s.task.left_out.lag : 100.0 * step;
      const double decay = __builtin_exp(-step / lag), decayed = 1.0 - decay;
      const double first = numbers(start)[l], before = numbers(rising)[l], after = numbers(falling)[l];
      const double k =
          (numbers(last[i])[l] - first - 0.5 * step * (before + after)) / (0.5 * step * (1.0 + decay) - lag * decayed);
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
      numbers(s.peak_time[i])[l] = numbers(began)[l] + from;
    }
  }

  static void look_at_wheels(State& s, Mask counts) {
    Lane* now = take_turns(s.F_seen);
    ++s.seen;
    for (int j = 0; j < s.task.wheels; ++j) {
      const Lane force = now[j] = CrossingContacts<W>::normal(s, j);
      s.least = counts & (force < s.least) ? force : s.least;
      s.greatest = counts & (force > s.greatest) ? force : s.greatest;
    }
    look_at_turns(s, 2);
  }

  /// What forces of wheels were between steps where they turn at the instant m, as app::WheelExtremes has it.
  static void look_at_turns(State& s, int m) {
    const double* at = s.s_seen;
    const Stencil by(at, m, s.seen);
    if (!by.three) return;
    const Mask counts = runs_until(s, at[m + 1]);
    for (int j = 0; j < s.task.wheels; ++j) {
      const double x = s.task.x[j];
      const Lane F = s.F_seen[m][j], before = F - s.F_seen[by.left][j], after = s.F_seen[by.right][j] - F;
      const Mask turns = counts & (before * after <= Lane{}) &
                         ((F - s.F_seen[m - 1][j]) * (s.F_seen[m + 1][j] - F) <= Lane{}) & (after != Lane{});
      if (!any(turns) || !smooth(s, x, at[by.left], at[by.right])) continue;
      Lane behind, top = turn(at, s.F_seen, j, m, by, false, behind);
      if (by.five && smooth(s, x, at[0], at[latest])) {
        Mask touched = s.F_seen[0][j] > Lane{};
        for (int i = 1; i < most; ++i) touched &= s.F_seen[i][j] > Lane{};
        top = touched ? turn(at, s.F_seen, j, m, by, true, behind) : top;
      }
      s.least = turns & (top < s.least) & (top > Lane{}) ? top : s.least;
      s.greatest = turns & (top > s.greatest) ? top : s.greatest;
    }
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
    for (int p = 0; p < n; ++p) lanes(s.task.kept)[s.kept * n + p] = s.row_of[latest][n + p];
    ++s.kept;
  }

  static void give(State& s) {
    look_at_last(s, 0);
    look_at_turns(s, latest - 1);
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
