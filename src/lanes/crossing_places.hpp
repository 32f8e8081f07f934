// Where wheels and forces are, on the bridge and on the track (crossing_kernel.hpp).
#pragma once

#include "lanes/crossing_influence.hpp"

namespace traverse::lanes {
namespace {

template <int W>
struct CrossingPlaces : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using State = CrossingState<W>;
  using Own::dot;
  using Own::influence_at;
  using Own::lanes;
  using Own::track_at;
  using typename Own::Lane;

  static constexpr double beside = 1e-9;  // m, of a kink: on the side that the step is on

  /// Wheels and forces when all have gone so far (m), with so many channels of the influence. Fills `free` with the
  /// penetration over a bridge at rest.
  static void place(State& s, double gone, int channels) {
    for (int v = 0; v < s.task.vehicles; ++v) {
      if (s.awake[v] == 0) continue;
      const TaskVehicle& vehicle = s.task.vehicle[v];
      s.touching[v] = 0;
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + s.task.kind[vehicle.kind].wheels; ++j) {
        Lane height;
        track_at(s.task.heights, s.task.x[j] + gone, height, s.lean[j]);
        s.along[j] = s.lean_of_bridge[j] = Lane{};
        s.free[j] = s.offset[j] + height;
        double* g = s.g + static_cast<long>(j) * s.task.influence.channels;
        double* slope = s.g_slope + static_cast<long>(j) * s.modes;
        const double x = s.task.x[j] + gone;
        s.on[j] = influence_at(s.task.influence, x, &s.piece[j], s.modes, channels, g, slope) ? 1 : 0;
        s.touching[v] = static_cast<char>(s.touching[v] | s.on[j]);
      }
    }
    for (int j = 0; j < s.task.loads; ++j) {
      double* g = s.load_g + static_cast<long>(j) * s.task.influence.channels;
      const double x = s.task.load_x[j] + gone;
      s.load_on[j] = influence_at(s.task.influence, x, &s.load_piece[j], 0, channels, g, nullptr) ? 1 : 0;
    }
    for (int i = 0; i < s.modes; ++i) s.load[i] = Lane{};
    for (int j = 0; j < s.task.loads; ++j) {
      if (s.load_on[j] == 0) continue;
      const double* g = s.load_g + static_cast<long>(j) * s.task.influence.channels;
      const Lane force = lanes(s.task.load)[j];
      for (int i = 0; i < s.modes; ++i) s.load[i] += g[i] * force;
    }
  }

  /// The start of a step: vehicles that stand still on level ground until their first wheel comes onto the bridge.
  static void place_vehicles(State& s, double gone) {
    s.start = gone;
    for (int v = 0; v < s.task.vehicles; ++v) s.awake[v] = gone + 1e-9 >= s.task.vehicle[v].rests_until ? 1 : 0;
  }

  /// The slope of the bridge added to that of the track, with the modes at q.
  static void lean_with_bridge(State& s, const Lane* q) {
    for (int v = 0; v < s.task.vehicles; ++v) {
      if (s.awake[v] == 0 || s.touching[v] == 0) continue;
      const TaskVehicle& vehicle = s.task.vehicle[v];
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + s.task.kind[vehicle.kind].wheels; ++j) {
        if (s.on[j] == 0) continue;
        s.lean_of_bridge[j] = -dot(s.g_slope + static_cast<long>(j) * s.modes, q, s.modes);
        s.lean[j] += s.lean_of_bridge[j];
      }
    }
  }

  /// The influence where each wheel of a vehicle touches the bridge: it has moved along the track, and on a slope it
  /// touches ahead of its centre, where that is higher. That lifts it by R times the bridge's slope squared; the circle
  /// of radius R has risen by half as much there.
  static void place_ahead(State& s, const TaskVehicle& vehicle) {
    for (int j = vehicle.first_wheel; j < vehicle.first_wheel + s.task.kind[vehicle.kind].wheels; ++j) {
      if (s.on[j] == 0) continue;
      const double* g = s.g + static_cast<long>(j) * s.task.influence.channels;
      const double* slope = s.g_slope + static_cast<long>(j) * s.modes;
      Lane* there = s.g_ahead + static_cast<long>(j) * s.modes;
      const Lane ahead = s.task.arm[j] * s.lean[j] + s.along[j];
      for (int i = 0; i < s.modes; ++i) there[i] = g[i] + ahead * slope[i];
      s.free[j] -= 0.5 * s.task.radius * s.lean_of_bridge[j] * s.lean_of_bridge[j];
    }
  }
};

}  // namespace
}  // namespace traverse::lanes
