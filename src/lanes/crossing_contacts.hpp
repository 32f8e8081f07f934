// The contacts' forces of a stage (crossing_kernel.hpp): in short steps one by one, otherwise all together in the
// modes.
#pragma once

#include "lanes/crossing_influence.hpp"

namespace traverse::lanes {
namespace {

template <int W>
struct CrossingContacts : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using State = CrossingState<W>;
  using Influence = CrossingInfluence<W>;
  using Own::any;
  using Own::factorise;
  using Own::fill;
  using Own::lanes;
  using Own::magnitude;
  using Own::multiply;
  using Own::root;
  using Own::solve;
  using typename Own::Lane;
  using typename Own::Mask;

  static constexpr double force_tolerance = 1e-9;  // of the force scale: what a contact's law may be missed by
  static constexpr int few_iterations = 6, most_iterations = 20, fresh_after = 4;
  static constexpr double least_penetration = 1e-12;  // m: below, the contact counts as lost

  /// The vertical force at a vertical penetration delta: on a slope cos and 1/cos of those along the normal.
  static Lane law(State& s, int j, Lane delta, Lane& tangent) {
    const Lane k = lanes(s.task.stiffness)[j] * (1.0 - (s.task.hertz[j] == 0 ? 1.0 : 1.25) * s.lean[j] * s.lean[j]);
    delta = delta > least_penetration ? delta : fill(least_penetration);
    if (s.task.hertz[j] == 0) {
      tangent = k;
      return k * delta;
    }
    const Lane steep = k * root(delta);
    tangent = 1.5 * steep;
    return steep * delta;
  }

  static Lane normal(const State& s, int j) { return s.F[j] * (1.0 + 0.5 * s.lean[j] * s.lean[j]); }

  /// In short steps masses hardly yield to a change of contact forces: each contact by itself, and all others as they
  /// were, converges fast. Where it does not, all together.
  static void solve_contacts(State& s) {
    for (int i = 0; i < s.modes; ++i) s.p[i] = Lane{};
    const Mask running = s.failed == Lane{};
    const Mask left = one_by_one(s, running & ~s.hard) | (running & s.hard);
    if (!any(left)) return;
    s.hard |= left;
    all_together(s, left);
  }

  /// Returns the lanes in which that did not converge.
  static Mask one_by_one(State& s, Mask open) {
    s.moved = fill(1e300);  // by how much forces have changed since the bridge was last pushed, N
    for (int iteration = 0; any(open); ++iteration) {
      if (iteration == few_iterations) return open;
      const Mask push = open & (s.yield_to_force * s.moved > force_tolerance * s.task.force_scale);
      if (any(push)) push_bridge(s, push);
      Mask wrong{};
      for (int v = 0; v < s.task.vehicles; ++v)
        if (s.awake[v] != 0) wrong |= update_one_by_one(s, v, open);
      open &= wrong;
    }
    return open;
  }

  /// s.p under the contacts' forces.
  static void push_bridge(State& s, Mask push) {
    for (int i = 0; i < s.modes; ++i) s.rhs[i] = Lane{};
    for (int v = 0; v < s.task.vehicles; ++v) {
      if (s.awake[v] == 0 || s.touching[v] == 0) continue;
      Influence::push(s, s.task.vehicle[v], s.rhs);
    }
    s.moved = push ? Lane{} : s.moved;
    for (int i = 0; i < s.modes; ++i) {
      Lane p{};
      if (s.task.coupled) {
        for (int j = 0; j < s.modes; ++j) p += s.S_inverse[i * s.modes + j] * s.rhs[j];
      } else {
        p = s.S_inverse[i] * s.rhs[i];
      }
      s.p[i] = push ? p : s.p[i];
    }
  }

  /// One step of Newton's for each contact; returns the lanes in which the penetrations were not yet right.
  static Mask update_one_by_one(State& s, int v, Mask open) {
    const TaskVehicle& vehicle = s.task.vehicle[v];
    const int w = s.task.kind[vehicle.kind].wheels, first = vehicle.first_wheel;
    const Lane* H = s.kinds[vehicle.kind].H;
    Lane* off = s.residual + first;
    for (int i = 0; i < w; ++i) {
      Lane c = s.free[first + i] - s.delta[first + i];
      for (int k = 0; k < w; ++k) c -= H[i * w + k] * s.F[first + k];
      off[i] = c;
    }
    if (s.touching[v] != 0) Influence::weigh(s, vehicle, s.p, s.residual);
    Mask wrong{};
    for (int i = 0; i < w; ++i) {
      const int j = first + i;
      const Lane change = magnitude(off[i]) * s.k[j];
      wrong |= change > force_tolerance * s.task.force_scale;
      if (s.on[j] != 0) s.moved += change;
      const Lane delta = s.delta[j] + off[i] / (1.0 + H[i * w + i] * s.k[j]);
      Lane tangent;
      const Lane force = law(s, j, delta, tangent);
      s.failed = (open & (delta <= fill(least_penetration))) ? fill(contact_lost) : s.failed;
      s.delta[j] = open ? delta : s.delta[j];
      s.F[j] = open ? force : s.F[j];
      s.k[j] = tangent;
    }
    return wrong;
  }

  static void all_together(State& s, Mask open) {
    bool on_bridge = false;
    for (int v = 0; v < s.task.vehicles; ++v) on_bridge |= s.awake[v] != 0 && s.touching[v] != 0;
    for (int iteration = 0; any(open); ++iteration) {
      if (iteration == most_iterations) {
        s.failed = open ? fill(not_converged) : s.failed;
        return;
      }
      const bool fresh = iteration % fresh_after == 0;
      if (fresh && on_bridge)
        for (int i = 0; i < s.modes * s.modes; ++i) s.factor[i] = s.S[i];
      for (int i = 0; i < s.modes; ++i) s.rhs[i] = Lane{};
      for (int v = 0; v < s.task.vehicles; ++v)
        if (s.awake[v] != 0) condense(s, v, fresh);
      if (on_bridge) {
        if (fresh) factorise(s.factor, s.modes, s.scaled);
        solve(s.factor, s.modes, s.rhs);
        for (int i = 0; i < s.modes; ++i) s.p[i] = open ? s.rhs[i] : s.p[i];
      }
      Mask wrong{};
      for (int v = 0; v < s.task.vehicles; ++v)
        if (s.awake[v] != 0) wrong |= update(s, v, open);
      open &= wrong;
    }
  }

  /// A vehicle's contacts into the modes' equations.
  static void condense(State& s, int v, bool fresh) {
    const TaskVehicle& vehicle = s.task.vehicle[v];
    const int w = s.task.kind[vehicle.kind].wheels, first = vehicle.first_wheel;
    Lane* L = s.D + s.D_begin[v];
    if (fresh) {
      const Lane* H = s.kinds[vehicle.kind].H;
      for (int i = 0; i < w; ++i) s.pivot[first + i] = 1.0 / s.k[first + i];
      for (int j = 0; j < w; ++j) {
        // Symmetric, but for rounding: the lower half serves. s.yield holds 1/k from here on.
        Lane pivot = H[j * w + j] + s.pivot[first + j];
        s.yield[first + j] = s.pivot[first + j];
        for (int k = 0; k < j; ++k) pivot -= L[j * w + k] * L[j * w + k] * L[k * w + k];
        L[j * w + j] = pivot;
        s.pivot[first + j] = 1.0 / pivot;
        for (int i = j + 1; i < w; ++i) {
          Lane entry = H[i * w + j];
          for (int k = 0; k < j; ++k) entry -= L[i * w + k] * L[j * w + k] * L[k * w + k];
          L[i * w + j] = entry * s.pivot[first + j];
        }
      }
    }
    for (int i = 0; i < w; ++i) {
      Lane r = s.free[first + i] - s.delta[first + i] + s.yield[first + i] * s.F[first + i];
      for (int k = 0; k < i; ++k) r -= L[i * w + k] * s.residual[first + k];
      s.residual[first + i] = r;
    }
    if (s.touching[v] == 0) return;
    Lane* rows = s.reduced + static_cast<long>(first) * s.modes;
    if (fresh) reduce(s, first, w, L, rows);
    for (int i = 0; i < w; ++i) {
      const Lane* row = rows + i * s.modes;
      const Lane weighted = s.residual[first + i] * s.pivot[first + i];
      for (int k = 0; k < s.modes; ++k) s.rhs[k] += row[k] * weighted;
    }
  }

  /// The rows of L^-1 g, and their share of the modes' matrix.
  static void reduce(State& s, int first, int w, const Lane* L, Lane* rows) {
    for (int i = 0; i < w; ++i) {
      Lane* row = rows + i * s.modes;
      if (s.on[first + i] != 0)
        Influence::copy(s, first + i, row);
      else
        for (int k = 0; k < s.modes; ++k) row[k] = Lane{};
      for (int j = 0; j < i; ++j) {
        const Lane* before = rows + j * s.modes;
        const Lane entry = L[i * w + j];
        for (int k = 0; k < s.modes; ++k) row[k] -= entry * before[k];
      }
    }
    int i = 0;
    for (; i + 2 <= w; i += 2) {
      const Lane *a = rows + i * s.modes, *b = a + s.modes;
      for (int k = 0; k < s.modes; ++k) {
        const Lane of_a = s.pivot[first + i] * a[k], of_b = s.pivot[first + i + 1] * b[k];
        Lane* to = s.factor + k * s.modes;
        for (int l = 0; l <= k; ++l) to[l] += of_a * a[l] + of_b * b[l];
      }
    }
    for (; i < w; ++i) {
      const Lane* a = rows + i * s.modes;
      for (int k = 0; k < s.modes; ++k) {
        const Lane of_a = s.pivot[first + i] * a[k];
        for (int l = 0; l <= k; ++l) s.factor[k * s.modes + l] += of_a * a[l];
      }
    }
  }

  /// New forces and penetrations from the modes' s.p; returns the lanes in which they miss the contacts' laws.
  static Mask update(State& s, int v, Mask open) {
    const TaskVehicle& vehicle = s.task.vehicle[v];
    const int w = s.task.kind[vehicle.kind].wheels, first = vehicle.first_wheel;
    const Lane* L = s.D + s.D_begin[v];
    if (s.touching[v] != 0)
      multiply(-1.0, s.reduced + static_cast<long>(first) * s.modes, w, s.modes, s.p, s.residual + first);
    Mask wrong{};
    for (int i = w - 1; i >= 0; --i) {
      Lane force = s.residual[first + i] * s.pivot[first + i];
      for (int k = i + 1; k < w; ++k) force -= L[k * w + i] * s.residual[first + k];
      s.residual[first + i] = force;
      const int j = first + i;
      const Lane delta = s.delta[j] + s.yield[j] * (force - s.F[j]);
      Lane tangent;
      const Lane by_law = law(s, j, delta, tangent);
      wrong |= magnitude(by_law - force) > force_tolerance * s.task.force_scale;
      s.failed = (open & (delta <= fill(least_penetration))) ? fill(contact_lost) : s.failed;
      s.delta[j] = open ? delta : s.delta[j];
      s.F[j] = open ? by_law : s.F[j];
      s.k[j] = tangent;
    }
    return wrong;
  }
};

}  // namespace
}  // namespace traverse::lanes
