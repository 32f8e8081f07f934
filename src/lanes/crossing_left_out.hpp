// What the modes that are left out do at the probes (crossing_kernel.hpp). They follow what the wheels' forces would
// bend them to at rest, c = sum c_j F_j of the influence's channels: deflections as one mode of their lowest frequency
// does, moments, which are made by many more modes, as all of them without inertia do, damped by b K.
//
//   r'' + (a + b omega^2) r' + omega^2 r = omega^2 c          b m' + m = c_m
//
// Without r'' deck accelerations need several times the modes, and without m moments under a wheel do not lag behind
// it.
#pragma once

#include "lanes/crossing_state.hpp"

namespace traverse::lanes {
namespace {

template <int W>
struct CrossingLeftOut : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using State = CrossingState<W>;
  using Own::lanes;
  using Own::numbers;
  using Own::oscillate;
  using typename Own::Lane;
  using typename Own::Oscillation;

  /// For steps of this length.
  static void set_step(State& s) {
    const TaskLeftOut& of = s.task.left_out;
    if (of.lag == 0.0) return;
    const double* h = numbers(s.h);
    for (int l = 0; l < W; ++l) {
      numbers(s.left_keeps)[l] = __builtin_exp(-h[l] / of.lag);
      for (int from = 0; from < 4; ++from) {
        const Oscillation end = oscillate(of.omega2, of.damping, h[l], from == 0 ? 1.0 : 0.0, from == 1 ? 1.0 : 0.0,
                                          from == 2 ? of.omega2 : 0.0, from == 3 ? of.omega2 : 0.0);
        numbers(s.to_left[from])[l] = end.u;
        numbers(s.to_left_rate[from])[l] = end.w;
      }
    }
  }

  /// Adds it to the responses [deflections, accelerations, moments, their rates] at the end of a step.
  static void add(State& s, Lane* seen) {
    const int n = s.task.probes.count;
    Lane* const bent = s.bent_to[0];
    s.bent_to[0] = s.bent_to[1];
    s.bent_to[1] = bent;
    for (int i = 0; i < 2 * n; ++i) bent[i] = Lane{};
    const auto bend = [&](const double* g, Lane force) {
      for (int i = 0; i < 2 * n; ++i) bent[i] += g[s.modes + i] * force;
    };
    for (int j = 0; j < s.task.wheels; ++j)
      if (s.on[j] != 0) bend(s.g + static_cast<long>(j) * s.task.influence.channels, s.F[j]);
    for (int j = 0; j < s.task.loads; ++j)
      if (s.load_on[j] != 0) bend(s.load_g + static_cast<long>(j) * s.task.influence.channels, lanes(s.task.load)[j]);
    if (s.ds == 0.0 || s.task.left_out.lag == 0.0)
      follow_at_once(s, seen);
    else
      follow(s, seen);
    s.h_before = s.h;
    s.behind_kink = false;
  }

 private:
  static void follow_at_once(State& s, Lane* seen) {
    const int n = s.task.probes.count;
    for (int i = 0; i < 2 * n; ++i) {
      s.left[i] = s.bent_to[1][i];
      s.left_rate[i] = Lane{};
      seen[i < n ? i : n + i] += s.left[i];
    }
  }

  // c is a parabola over the last three instants, unless there is a kink between these: start + slope t + bend t^2.
  // What is left of r less P + Q t + bend t^2, which follows that, is free or follows a straight line.
  static void follow(State& s, Lane* seen) {
    const int n = s.task.probes.count;
    const TaskLeftOut& of = s.task.left_out;
    for (int i = 0; i < 2 * n; ++i) {
      const Lane start = s.bent_to[0][i], end = s.bent_to[1][i], rise = (end - start) / s.h;
      const Lane bend = s.behind_kink ? Lane{} : (rise - s.bend_rate[i]) / (s.h + s.h_before);
      s.bend_rate[i] = rise;
      if (i < n) {
        const Lane Q = -2.0 * of.damping / of.omega2 * bend, P = -(of.damping * Q + 2.0 * bend) / of.omega2;
        const Lane r = s.left[i] - P, rate = s.left_rate[i] - Q, line = end - bend * s.h * s.h;
        s.left[i] = s.to_left[0] * r + s.to_left[1] * rate + s.to_left[2] * start + s.to_left[3] * line +
                    (P + s.h * (Q + s.h * bend));
        s.left_rate[i] = s.to_left_rate[0] * r + s.to_left_rate[1] * rate + s.to_left_rate[2] * start +
                         s.to_left_rate[3] * line + (Q + 2.0 * bend * s.h);
        seen[i] += s.left[i];
        seen[n + i] += of.omega2 * (end - s.left[i]) - of.damping * s.left_rate[i];
      } else {
        const Lane Q = rise - bend * s.h - 2.0 * of.lag * bend, P = start - of.lag * Q;
        s.left[i] = s.left_keeps * (s.left[i] - P) + (P + s.h * (Q + s.h * bend));
        seen[n + i] += s.left[i];
        seen[2 * n + i] += (end - s.left[i]) / of.lag;
      }
    }
  }
};

}  // namespace
}  // namespace traverse::lanes
