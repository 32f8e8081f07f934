// The energies that come and go in a crossing that is taken step by step (crossing_kernel.hpp): what dampers lose, and
// what holds the vehicles' speed gives. A wheel that climbs the track and the bent bridge is pushed up these slopes:
//
//   P = driven x'' + speed * sum F d(surface)/dx
#pragma once

#include "lanes/crossing_places.hpp"

namespace traverse::lanes {
namespace {

template <int W>
struct CrossingPowers : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using State = CrossingState<W>;
  using Own::dot;
  using Own::influence_slope_at;
  using Own::lanes;
  using Own::sum;
  using Own::track_at;
  using typename Own::Lane;

  static void begin(State& s) {
    s.all_lost = s.all_given = Lane{};
    s.lost[0] = Lane{};
    begin_behind_kink(s);
  }

  /// At the start of a step where the surface may have a kink: its slopes are those in front of the wheels.
  static void begin_behind_kink(State& s) {
    lean_beside(s, s.distance + CrossingPlaces<W>::beside, s.q);
    s.given[0] = given(s, 0);
  }

  /// At a stage that is solved. before_kink: the surface may have a kink there, and the wheels are still on this side.
  static void note(State& s, int stage, bool before_kink) {
    Lane lost{};
    for (int v = 0; v < s.task.vehicles; ++v)
      if (s.awake[v] != 0) lost += lost_in_vehicle(s, v, stage);
    for (int i = 0; i < s.modes; ++i) {
      s.scaled[i] = s.task.exact_modes ? s.q[i] : s.z[i] + s.p[i];
      s.rhs[i] = s.task.exact_modes ? s.r[i] : s.r_still[i] + s.rate * s.b[stage][i];
    }
    s.lost[stage] = lost + lost_in_modes(s, s.rhs);
    if (before_kink)
      lean_beside(s, s.start + s.task.method.time[stage - 1] * s.ds - CrossingPlaces<W>::beside, s.scaled);
    s.given[stage] = given(s, stage);
  }

  static void finish_step(State& s) {
    const TaskMethod& method = s.task.method;
    for (int j = 0; j < method.known; ++j) {
      s.all_lost += method.power[j] * s.h * s.lost[j];
      s.all_given += method.power[j] * s.h * s.given[j];
    }
    s.lost[0] = s.lost[method.known - 1];
    s.given[0] = s.given[method.known - 1];
  }

 private:
  static Lane lost_in_vehicle(State& s, int v, int stage) {
    const TaskVehicle& vehicle = s.task.vehicle[v];
    const TaskKind& kind = s.task.kind[vehicle.kind];
    const int f = kind.freedom, first = vehicle.first_coordinate;
    const Lane *a = s.a[stage] + first, *w_still = s.still + 2 * first + f;
    Lane* w = s.a_free + first;
    for (int i = 0; i < f; ++i) w[i] = w_still[i] + s.rate * a[i];
    Lane lost{};
    for (int i = 0; i < kind.losses; ++i) lost += lanes(kind.loss)[i] * w[kind.loss_row[i]] * w[kind.loss_column[i]];
    return lost;
  }

  static Lane lost_in_modes(const State& s, const Lane* rate) {
    const Lane* c = lanes(s.task.damping);
    if (!s.task.coupled) return sum(s.modes, [=](int i) { return c[i] * rate[i] * rate[i]; });
    Lane lost{};
    for (int i = 0; i < s.modes; ++i)
      for (int j = 0; j < s.modes; ++j) lost += rate[i] * c[i * s.modes + j] * rate[j];
    return lost;
  }

  static Lane given(State& s, int stage) {
    Lane given{};
    for (int v = 0; v < s.task.vehicles; ++v) {
      if (s.awake[v] == 0) continue;
      const TaskVehicle& vehicle = s.task.vehicle[v];
      const TaskKind& kind = s.task.kind[vehicle.kind];
      const Lane* a = s.a[stage] + vehicle.first_coordinate;
      for (int i = 0; i < kind.freedom; ++i) given += lanes(kind.driven)[i] * a[i];
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + kind.wheels; ++j)
        given += s.speed * s.F[j] * s.lean[j];
    }
    return given;
  }

  /// The slopes of the surface under wheels that have gone so far (m), with the modes at q.
  static void lean_beside(State& s, double gone, const Lane* q) {
    const TaskInfluence& line = s.task.influence;
    for (int j = 0; j < s.task.wheels; ++j) {
      const double x = s.task.x[j] + gone;
      Lane height;
      track_at(s.task.heights, x, height, s.lean[j]);
      if (x < line.breaks[0] || x > line.breaks[line.pieces]) continue;
      int piece = s.piece[j];
      while (piece > 0 && x < line.breaks[piece]) --piece;
      while (piece + 1 < line.pieces && x >= line.breaks[piece + 1]) ++piece;
      double* rises = s.g_slope + static_cast<long>(j) * s.modes;
      influence_slope_at(line, x, piece, s.modes, rises);
      s.lean[j] -= dot(rises, q, s.modes);
    }
  }
};

}  // namespace
}  // namespace traverse::lanes
