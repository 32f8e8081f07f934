// The modes' influence under wheels on the bridge, where each lane's wheel touches it (crossing_kernel.hpp).
#pragma once

#include "lanes/crossing_state.hpp"

namespace traverse::lanes {
namespace {

template <int W>
struct CrossingInfluence : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using Own::dot;
  using State = CrossingState<W>;
  using Lane = typename State::Lane;

  /// Takes from `sums` of the vehicle's wheels on the bridge what the modes at q have of each one's influence.
  static void weigh(const State& s, const TaskVehicle& vehicle, const Lane* q, Lane* sums) {
    with_influence(s, vehicle, [&](const Lane* const* g, const int* wheel, int count) {
      int k = 0;
      for (; k + 4 <= count; k += 4) weigh_four(g + k, wheel + k, q, s.modes, sums);
      for (; k < count; ++k) sums[wheel[k]] -= dot(g[k], q, s.modes);
    });
  }
  /// Adds to the modal forces those of the vehicle's wheels on the bridge.
  static void push(const State& s, const TaskVehicle& vehicle, Lane* modal) {
    with_influence(s, vehicle, [&](const Lane* const* g, const int* wheel, int count) {
      int k = 0;
      for (; k + 4 <= count; k += 4) push_four(g + k, wheel + k, s.F, s.modes, modal);
      for (; k < count; ++k) add(g[k], s.F[wheel[k]], modal, s.modes);
    });
  }
  /// The influence itself of a wheel on the bridge.
  static void copy(const State& s, int j, Lane* to) {
    const Lane* g = s.g_ahead + static_cast<long>(j) * s.modes;
    for (int i = 0; i < s.modes; ++i) to[i] = g[i];
  }

 private:
  static constexpr int most_at_once = 8;

  /// Calls use(influences, their wheels, how many) for the vehicle's wheels on the bridge, some at a time.
  template <class Use>
  static void with_influence(const State& s, const TaskVehicle& vehicle, Use use) {
    const Lane* influence[most_at_once];
    int wheel[most_at_once], count = 0;
    const int end = vehicle.first_wheel + s.task.kind[vehicle.kind].wheels;
    for (int j = vehicle.first_wheel; j < end; ++j) {
      if (s.on[j] != 0) {
        influence[count] = s.g_ahead + static_cast<long>(j) * s.modes;
        wheel[count++] = j;
      }
      if (count < most_at_once && (j + 1 < end || count == 0)) continue;
      use(influence, wheel, count);
      count = 0;
    }
  }

  static void weigh_four(const Lane* const* g, const int* wheel, const Lane* q, int modes, Lane* sums) {
    const Lane *g0 = g[0], *g1 = g[1], *g2 = g[2], *g3 = g[3];
    Lane s0{}, s1{}, s2{}, s3{};
    for (int i = 0; i < modes; ++i) {
      s0 += g0[i] * q[i];
      s1 += g1[i] * q[i];
      s2 += g2[i] * q[i];
      s3 += g3[i] * q[i];
    }
    sums[wheel[0]] -= s0;
    sums[wheel[1]] -= s1;
    sums[wheel[2]] -= s2;
    sums[wheel[3]] -= s3;
  }
  static void push_four(const Lane* const* g, const int* wheel, const Lane* F, int modes, Lane* modal) {
    const Lane *g0 = g[0], *g1 = g[1], *g2 = g[2], *g3 = g[3];
    const Lane F0 = F[wheel[0]], F1 = F[wheel[1]], F2 = F[wheel[2]], F3 = F[wheel[3]];
    for (int i = 0; i < modes; ++i) modal[i] += (g0[i] * F0 + g1[i] * F1) + (g2[i] * F2 + g3[i] * F3);
  }
  static void add(const Lane* g, Lane force, Lane* modal, int modes) {
    for (int i = 0; i < modes; ++i) modal[i] += g[i] * force;
  }
};

}  // namespace
}  // namespace traverse::lanes
