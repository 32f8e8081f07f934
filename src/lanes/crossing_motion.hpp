// Vehicles and modes in a stage without the contacts' forces, and under them (crossing_kernel.hpp).
#pragma once

#include "lanes/crossing_state.hpp"

namespace traverse::lanes {
namespace {

template <int W>
struct CrossingMotion : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using State = CrossingState<W>;
  using Own::any;
  using Own::invert;
  using Own::lanes;
  using Own::magnitude;
  using Own::multiply;
  using Own::numbers;
  using Own::oscillate;
  using Own::predict;
  using typename Own::Lane;
  using typename Own::Mask;
  using typename Own::Oscillation;
  using typename Own::Rule;

  static void set_exact_modes(State& s) {
    const double* k = s.task.omega2;
    const double* c = s.task.damping;
    const double* h = numbers(s.h);
    for (int i = 0; i < s.modes; ++i) {
      for (int from = 0; from < 4; ++from) {
        double* u = numbers(s.to_q[4 * i + from]);
        double* w = numbers(s.to_r[4 * i + from]);
        for (int l = 0; l < W; ++l) {
          const Oscillation end = oscillate(k[i * W + l], c[i * W + l], h[l], from == 0 ? 1.0 : 0.0,
                                            from == 1 ? 1.0 : 0.0, from == 2 ? 1.0 : 0.0, from == 3 ? 1.0 : 0.0);
          u[l] = end.u;
          w[l] = end.w;
        }
      }
      s.S[i * s.modes + i] = 1.0 / s.to_q[4 * i + 3];
      s.S_inverse[i] = s.to_q[4 * i + 3];
    }
  }

  static void renew(State& s, const TaskKind& kind, const typename State::Kind& own) {
    const int f = kind.freedom, w = kind.wheels;
    for (int i = 0; i < f * f; ++i)
      own.inverse[i] = lanes(kind.M)[i] + s.rate * lanes(kind.C)[i] + s.d * lanes(kind.K)[i];
    invert(own.inverse, f);
    for (int i = 0; i < f; ++i) {
      const Lane* row = own.inverse + i * f;
      Lane* to = own.by_state + 2 * i * f;
      own.alone[i] = Lane{};
      for (int j = 0; j < 2 * f; ++j) to[j] = Lane{};
      for (int k = 0; k < f; ++k) {
        own.alone[i] -= row[k] * lanes(kind.r0)[k];
        for (int j = 0; j < f; ++j) {
          to[j] += row[k] * lanes(kind.K)[k * f + j];
          to[f + j] += row[k] * lanes(kind.C)[k * f + j];
        }
      }
    }
    for (int i = 0; i < f; ++i)
      for (int j = 0; j < w; ++j) {
        Lane sum{};
        for (int e = kind.G_row[j]; e < kind.G_row[j + 1]; ++e) {
          const int k = kind.G_column[e];
          sum += own.inverse[i * f + k] * lanes(kind.G)[j * f + k];
        }
        own.Y[i * w + j] = sum;
        Lane along{};
        for (int k = 0; k < f; ++k) along += own.inverse[i * f + k] * lanes(kind.G_along)[j * f + k];
        own.Y_along[i * w + j] = along;
      }
    for (int i = 0; i < w; ++i)
      for (int j = 0; j < w; ++j) {
        Lane sum{};
        for (int e = kind.G_row[i]; e < kind.G_row[i + 1]; ++e) {
          const int k = kind.G_column[e];
          sum += lanes(kind.G)[i * f + k] * own.Y[k * w + j];
        }
        own.H[i * w + j] = s.d * sum;
      }
  }

  static bool leans(const State& s, int v) { return s.task.heights.stations > 0 || s.touching[v] != 0; }

  /// Without contact forces.
  static void free_vehicle(State& s, int v, int known, const Rule& rule) {
    const TaskVehicle& vehicle = s.task.vehicle[v];
    const TaskKind& kind = s.task.kind[vehicle.kind];
    const typename State::Kind& own = s.kinds[vehicle.kind];
    const int f = kind.freedom, first = vehicle.first_coordinate;
    Lane *x = s.still + 2 * first, *w = x + f, *a = s.a_free + first;
    predict(known, f, rule, s.x + first, s.w + first, s.a, first, x, w);
    for (int i = 0; i < f; ++i) a[i] = own.alone[i];
    multiply(-1.0, own.by_state, f, 2 * f, x, a);
    if (leans(s, v))
      for (int j = 0; j < kind.wheels; ++j) {
        // The contact's force stands square on the surface: it pushes along it by its slope, as it was last found.
        const Lane push = s.lean[vehicle.first_wheel + j] * s.F[vehicle.first_wheel + j];
        for (int i = 0; i < f; ++i) a[i] -= own.Y_along[i * kind.wheels + j] * push;
      }
    lift_wheels(s, v, [=, d = s.d](int k) { return x[k] + d * a[k]; });
  }

  /// By coordinates of their vehicle: what that takes from their penetrations, and how far they move along the track.
  template <class Coordinate>
  static void lift_wheels(State& s, int v, Coordinate coordinate) {
    const TaskVehicle& vehicle = s.task.vehicle[v];
    const TaskKind& kind = s.task.kind[vehicle.kind];
    const int f = kind.freedom;
    for (int j = 0; j < kind.wheels; ++j) {
      Lane up{};
      for (int e = kind.G_row[j]; e < kind.G_row[j + 1]; ++e) {
        const int k = kind.G_column[e];
        up += lanes(kind.G)[j * f + k] * coordinate(k);
      }
      s.free[vehicle.first_wheel + j] -= up;
      if (!leans(s, v)) continue;
      Lane along{};
      for (int k = 0; k < f; ++k) along += lanes(kind.G_along)[j * f + k] * coordinate(k);
      const int wheel = vehicle.first_wheel + j;
      s.along[wheel] = along;
      s.free[wheel] += (s.lean[wheel] - s.lean_of_bridge[wheel]) * along;
    }
  }

  /// s.z: where the modes would be without the contacts.
  static void free_modes(State& s) {
    const Lane* c = lanes(s.task.damping);
    if (!s.task.coupled) {
      for (int i = 0; i < s.modes; ++i)
        s.z[i] = s.q_still[i] + s.S_inverse[i] * (s.load[i] - c[i] * s.r_still[i] - s.omega2[i] * s.q_still[i]);
      return;
    }
    for (int i = 0; i < s.modes; ++i) {
      s.rhs[i] = s.load[i] - s.omega2[i] * s.q_still[i];
      for (int j = 0; j < s.modes; ++j) s.rhs[i] -= c[i * s.modes + j] * s.r_still[j];
    }
    for (int i = 0; i < s.modes; ++i) {
      s.z[i] = s.q_still[i];
      for (int j = 0; j < s.modes; ++j) s.z[i] += s.S_inverse[i * s.modes + j] * s.rhs[j];
    }
  }

  static void free_exact_modes(State& s) {
    const Lane* c = lanes(s.task.damping);
    for (int i = 0; i < s.modes; ++i) {
      const Lane* to = s.to_q + 4 * i;
      const Lane before = s.b[0][i] + c[i] * s.r[i] + s.omega2[i] * s.q[i];
      s.z[i] = to[0] * s.q[i] + to[1] * s.r[i] + to[2] * before + to[3] * s.load[i];
    }
  }

  static void move_exact_modes(State& s) {
    const Lane* c = lanes(s.task.damping);
    for (int i = 0; i < s.modes; ++i) {
      const Lane* to = s.to_r + 4 * i;
      const Lane before = s.b[0][i] + c[i] * s.r[i] + s.omega2[i] * s.q[i];
      const Lane after = s.load[i] + s.S[i * s.modes + i] * s.p[i];
      s.r[i] = to[0] * s.q[i] + to[1] * s.r[i] + to[2] * before + to[3] * after;
      s.q[i] = s.z[i] + s.p[i];
      s.b[0][i] = after - c[i] * s.r[i] - s.omega2[i] * s.q[i];
    }
  }

  static void take_forces(State& s, int v, int stage) {
    const TaskVehicle& vehicle = s.task.vehicle[v];
    const TaskKind& kind = s.task.kind[vehicle.kind];
    Lane* a = s.a[stage] + vehicle.first_coordinate;
    for (int i = 0; i < kind.freedom; ++i) a[i] = s.a_free[vehicle.first_coordinate + i];
    multiply(1.0, s.kinds[vehicle.kind].Y, kind.freedom, kind.wheels, s.F + vehicle.first_wheel, a);
  }

  /// Keeps the coordinates at which the mechanism is farthest from linear.
  static void note_bent(State& s, int v) {
    const TaskVehicle& vehicle = s.task.vehicle[v];
    const TaskKind& kind = s.task.kind[vehicle.kind];
    const Lane* x = s.x + vehicle.first_coordinate;
    Lane bent{};
    for (int i = 0; i < kind.freedom; ++i) bent += kind.bend[i] * magnitude(x[i]);
    const Mask more = bent > s.most_bent[v];
    if (!any(more)) return;
    s.most_bent[v] = more ? bent : s.most_bent[v];
    Lane* kept = s.bent + vehicle.first_coordinate;
    for (int i = 0; i < kind.freedom; ++i) kept[i] = more ? x[i] : kept[i];
  }
};

}  // namespace
}  // namespace traverse::lanes
