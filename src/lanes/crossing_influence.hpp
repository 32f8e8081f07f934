// The modes' influence under wheels on the bridge (crossing_kernel.hpp): the same in all lanes on a level track; on
// another one where each lane's wheel touches it.
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

  /// The sum over the modes of influence times q.
  static Lane weigh(const State& s, int j, const Lane* q) {
    return s.g_ahead == nullptr ? dot(s.g + static_cast<long>(j) * s.task.influence.channels, q, s.modes)
                                : dot(s.g_ahead + static_cast<long>(j) * s.modes, q, s.modes);
  }
  /// Adds to the modal forces those of a force at the wheel.
  static void push(const State& s, int j, Lane force, Lane* modal) {
    if (s.g_ahead == nullptr)
      add(s.g + static_cast<long>(j) * s.task.influence.channels, force, modal, s.modes);
    else
      add(s.g_ahead + static_cast<long>(j) * s.modes, force, modal, s.modes);
  }
  /// The influence itself.
  static void copy(const State& s, int j, Lane* to) {
    for (int i = 0; i < s.modes; ++i) to[i] = Lane{};
    push(s, j, Lane{} + 1.0, to);
  }

 private:
  template <class Number>
  static void add(const Number* g, Lane force, Lane* modal, int modes) {
    for (int i = 0; i < modes; ++i) modal[i] += g[i] * force;
  }
};

}  // namespace
}  // namespace traverse::lanes
