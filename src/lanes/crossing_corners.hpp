// Wheels that pass a corner of the surface: an end of the bridge, a hinge, a kink of the track (crossing_kernel.hpp).
//
// A step ends where a wheel would meet the corner if the vehicle did not move it along the track. A wheel that touches
// the track a distance u ahead of that place has met the corner u/v before the step ends, and since then its
// penetration has grown by the corner's angle times v. At the end of the step the force by the far side's surface
// therefore differs by D from the force by the near side's. There the accelerations change by what D makes of them, and
// the vehicle's velocities by the impulse that the step has missed, D u/(2 v).
#pragma once

#include "lanes/crossing_contacts.hpp"
#include "lanes/crossing_motion.hpp"
#include "lanes/crossing_places.hpp"

namespace traverse::lanes {
namespace {

template <int W>
struct CrossingCorners : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using State = CrossingState<W>;
  using Contacts = CrossingContacts<W>;
  using Influence = CrossingInfluence<W>;
  using Motion = CrossingMotion<W>;
  using Places = CrossingPlaces<W>;
  using Own::any;
  using Own::greater;
  using Own::lanes;
  using Own::magnitude;
  using Own::multiply;
  using typename Own::Lane;
  using typename Own::Mask;

  static constexpr double least_corner = 1e-10;  // of slope

  /// From the end of a step, where wheels may be at a corner, to the start of the next.
  static void pass(State& s) {
    Places::place_vehicles(s, s.distance);
    stand(s, s.distance - Places::beside);
    for (int j = 0; j < s.task.wheels; ++j) {
      s.residual[j] = s.free[j];
      s.yield[j] = s.F[j];
      s.pivot[j] = s.lean[j];
      Lane* near = s.reduced + static_cast<long>(j) * s.modes;
      for (int i = 0; i < s.modes; ++i) near[i] = Lane{};
      if (s.on[j] != 0) Influence::copy(s, j, near);
    }
    stand(s, s.distance + Places::beside);
    for (int v = 0; v < s.task.vehicles; ++v)
      if (s.awake[v] != 0) change_forces(s, v);
  }

 private:
  /// The contacts' forces as vehicles and bridge are, with the wheels at this distance.
  static void stand(State& s, double gone) {
    Places::place(s, gone, s.modes);
    Places::lean_with_bridge(s, s.q);
    for (int v = 0; v < s.task.vehicles; ++v) {
      if (s.awake[v] == 0) continue;
      const TaskVehicle& vehicle = s.task.vehicle[v];
      const Lane* x = s.x + vehicle.first_coordinate;
      Motion::lift_wheels(s, v, [=](int i) { return x[i]; });
      if (s.touching[v] != 0) {
        Places::place_ahead(s, vehicle);
        Influence::weigh(s, vehicle, s.q, s.free);
      }
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + s.task.kind[vehicle.kind].wheels; ++j)
        s.F[j] = Contacts::law(s, j, s.delta[j] = s.free[j], s.k[j]);
    }
  }

  /// The forces of a vehicle's wheels at a corner become those of the far side.
  static void change_forces(State& s, int v) {
    const TaskVehicle& vehicle = s.task.vehicle[v];
    const TaskKind& kind = s.task.kind[vehicle.kind];
    const int f = kind.freedom, first = vehicle.first_coordinate;
    Lane *missed = s.still + 2 * first, *kick = missed + f, *push = s.a_free + first;
    for (int i = 0; i < f; ++i) missed[i] = kick[i] = push[i] = Lane{};
    bool at_corner = false;
    for (int k = 0; k < kind.wheels; ++k) {
      const int j = vehicle.first_wheel + k;
      const Lane corner = s.lean[j] - s.pivot[j];
      const Mask turns = magnitude(corner) > Own::fill(least_corner);
      if (!any(turns)) continue;
      at_corner = true;
      Lane ahead = (s.free[j] - s.residual[j]) / corner;
      ahead = turns & (magnitude(ahead) < Own::fill(s.task.radius)) ? ahead : Lane{};
      s.edge = greater(s.edge, magnitude(corner) * ahead * ahead);
      const Lane late = 0.5 * ahead / s.speed;
      const Lane up = turns ? s.F[j] - s.yield[j] : Lane{};
      const Lane along = turns ? s.pivot[j] * s.yield[j] - s.lean[j] * s.F[j] : Lane{};
      const Lane *G = lanes(kind.G) + k * f, *G_along = lanes(kind.G_along) + k * f;
      for (int i = 0; i < f; ++i) {
        push[i] += G[i] * up + G_along[i] * along;
        missed[i] += late * G[i] * up;
      }
      push_modes(s, j, turns);
    }
    if (!at_corner) return;
    const Lane* M_inverse = s.kinds[vehicle.kind].M_inverse;
    multiply(1.0, M_inverse, f, f, missed, kick);
    multiply(-1.0, lanes(kind.C), f, f, kick, push);
    multiply(1.0, M_inverse, f, f, push, s.a[0] + first);
    for (int i = 0; i < f; ++i) s.w[first + i] += kick[i];
  }

  static void push_modes(State& s, int j, Mask turns) {
    const Lane* near = s.reduced + static_cast<long>(j) * s.modes;
    const Lane* far = s.g_ahead + static_cast<long>(j) * s.modes;
    for (int i = 0; i < s.modes; ++i) {
      const Lane share = s.on[j] != 0 ? far[i] * s.F[j] : Lane{};
      s.b[0][i] += turns ? share - near[i] * s.yield[j] : Lane{};
    }
  }
};

}  // namespace
}  // namespace traverse::lanes
