// The motion of several runs at once, one in each lane of the processor's vectors. All runs of a group take their steps
// by distance: wheels and forces are at the same stations in every lane, so that all meet bridge ends, probes and bumps
// in the same step, and shapes, influence lines and places are looked up once for all.
//
// A stage of a step has, with w = w~ + rate a, v = v~ + d a for coordinates of vehicles and modes alike:
//
//   vehicles   J a = G^T F - r0 - C w~ - K v~,   J = M + rate C + d K, inverted once a step length; H = d G J^-1 G^T
//   modes      S p = g^T F, S = (1 + rate c)/d + omega^2: what the contacts push the bridge down by, with g the modal
//              forces of unit forces at the wheels
//   contacts   F = F(delta),   delta = delta_free - H F - g p
//
// The contacts' Newton iteration puts everything into the modes: with D = 1/k + H of each vehicle by itself
//
//   (S + sum g^T D^-1 g) p = sum g^T D^-1 r,   F = D^-1 (r - g p),   r = delta_free - delta + F/k
//
// Methods of one solve a step need not step the modes at all: these move exactly under forces that are linear over the
// step, q = e11 q_0 + e12 q'_0 + u0 f_0 + u1 f_1, so that S = 1/u1. Only vehicles and contacts are left to the method.
//
// This file is compiled once for each kind of processor. Nothing in it may be seen by the linker, or code for one
// processor could be taken for another: no functions of the library, everything in an unnamed namespace.
#pragma once

#include "lanes/crossing_corners.hpp"
#include "lanes/crossing_looks.hpp"
#include "lanes/crossing_motion.hpp"
#include "lanes/crossing_places.hpp"

namespace traverse::lanes {
namespace {

template <int W>
class Group : CrossingAlgebra<W> {
  using Own = CrossingAlgebra<W>;
  using State = CrossingState<W>;
  using Contacts = CrossingContacts<W>;
  using Influence = CrossingInfluence<W>;
  using Motion = CrossingMotion<W>;
  using Looks = CrossingLooks<W>;
  using Places = CrossingPlaces<W>;
  using Own::any;
  using Own::fill;
  using Own::invert;
  using Own::lanes;
  using Own::predict;
  using typename Own::Lane;
  using typename Own::Mask;
  using typename Own::Rule;

 public:
  Group(const Task& task, double* work) : state_(task) { CrossingMemory<W>::lay_out(state_, work); }
  long size() const { return state_.used * W; }

  void run() {
    State& s = state_;
    begin(s);
    double from = 0.0;
    bool kink = true;
    if (s.task.kept != nullptr) Looks::keep(s);
    for (int i = 0; i < s.task.stretches; ++i) {
      const TaskStretch& stretch = s.task.stretch[i];
      const double ds = (stretch.to - from) / static_cast<double>(stretch.steps);
      set_step(s, ds);
      s.behind_kink = kink;
      for (long k = 0; k < stretch.steps; ++k) {
        Places::place_vehicles(s, from + static_cast<double>(k) * ds);
        const bool to_kink = stretch.kink && k + 1 == stretch.steps;
        for (int stage = 0; stage < s.task.method.stages; ++stage) solve_stage(s, stage, to_kink);
        finish_step(s);
        s.distance = k + 1 < stretch.steps ? from + static_cast<double>(k + 1) * ds : stretch.to;
        Looks::look(s, true);
      }
      kink = stretch.kink;
      if (kink) Looks::look_before_kink(s);  // moments may have one there
      if (stretch.keeps) Looks::keep(s);
      if (!any(s.failed == fill(0.0))) break;
      if (kink) CrossingCorners<W>::pass(s);
      from = stretch.to;
    }
    Looks::give(s);
  }

 private:
  static constexpr double same_step = 1e-10;  // far above what rounding leaves of differences of distances

  static void begin(State& s) {
    for (int i = 0; i < s.task.coordinates; ++i) {
      s.x[i] = s.bent[i] = Lane{};
      s.w[i] = lanes(s.task.x_rate)[i];
      for (int j = 0; j < s.task.method.known; ++j) s.a[j][i] = Lane{};
    }
    for (int i = 0; i < s.modes; ++i) {
      s.q[i] = lanes(s.task.q)[i];
      s.r[i] = s.p[i] = Lane{};
      s.omega2[i] = lanes(s.task.omega2)[i];
      for (int j = 0; j < s.task.method.known; ++j) s.b[j][i] = Lane{};
    }
    for (int j = 0; j < s.task.wheels; ++j) {
      s.piece[j] = 0;
      s.offset[j] = s.slope[j] = Lane{};
    }
    for (int j = 0; j < s.task.loads; ++j) s.load_piece[j] = 0;
    for (int v = 0; v < s.task.vehicles; ++v) {
      s.awake[v] = 1;
      s.most_bent[v] = Lane{};
    }
    s.speed = *lanes(s.task.speed);
    s.end_time = *lanes(s.task.end_time);
    s.failed = Lane{};
    s.least = fill(1e300);
    s.greatest = fill(-1e300);
    s.edge = Lane{};
    for (int k = 0; k < s.task.kinds; ++k) {
      const TaskKind& kind = s.task.kind[k];
      for (int i = 0; i < kind.freedom * kind.freedom; ++i) s.kinds[k].M_inverse[i] = lanes(kind.M)[i];
      invert(s.kinds[k].M_inverse, kind.freedom);
    }
    for (int i = 0; i < 3 * s.task.probes.count; ++i) s.peak[i] = s.peak_time[i] = Lane{};
    s.distance = s.start = 0.0;
    s.ds = s.ds_before = 0.0;
    s.known = s.looks = s.seen = 0;
    // The wheels' heights over the bridge as it stands.
    Places::place(s, 0.0, s.task.influence.channels);
    Places::lean_with_bridge(s, s.q);
    for (int v = 0; v < s.task.vehicles; ++v) {
      if (s.touching[v] == 0) continue;
      Places::place_ahead(s, s.task.vehicle[v]);
      Influence::weigh(s, s.task.vehicle[v], s.q, s.free);
    }
    for (int j = 0; j < s.task.wheels; ++j) {
      s.delta[j] = s.end[j] = lanes(s.task.penetration)[j] * (1.0 + 0.5 * s.lean[j] * s.lean[j]);
      s.offset[j] = s.delta[j] - s.free[j];
      s.F[j] = Contacts::law(s, j, s.delta[j], s.k[j]);
      s.F_seen[4][j] = Contacts::normal(s, j);
    }
    Looks::look(s, false);
  }

  static void set_step(State& s, double ds) {
    const double change = ds - s.ds;
    if ((change < 0.0 ? -change : change) <= same_step * ds) return;
    s.hard = Mask{};
    renew_step(s, ds);
    CrossingLeftOut<W>::set_step(s);
    s.yield_to_force = fill(1.0);
    if (s.task.coupled) return;
    Lane compliance{}, stiffest{};
    for (int i = 0; i < s.modes; ++i)
      compliance += s.task.influence.largest[i] * s.task.influence.largest[i] * s.S_inverse[i];
    for (int j = 0; j < s.task.wheels; ++j) stiffest = s.k[j] > stiffest ? s.k[j] : stiffest;
    s.yield_to_force = 2.0 * compliance * stiffest;  // a tangent is not twice as steep under any force that holds
  }

  static void renew_step(State& s, double ds) {
    s.ds = ds;
    s.h = ds / s.speed;
    s.rate = s.task.method.rate * s.h;
    s.d = s.task.method.displacement * s.h * s.h;
    for (int k = 0; k < s.task.kinds; ++k) Motion::renew(s, s.task.kind[k], s.kinds[k]);
    for (int i = 0; i < s.modes; ++i)
      for (int j = 0; j < s.modes; ++j) s.S[i * s.modes + j] = Lane{};
    for (int i = 0; i < s.modes; ++i) s.S[i * s.modes + i] = 1.0 / s.d + s.omega2[i];
    const Lane over = s.rate / s.d;
    const Lane* c = lanes(s.task.damping);
    if (s.task.exact_modes) return Motion::set_exact_modes(s);
    if (!s.task.coupled) {
      for (int i = 0; i < s.modes; ++i) {
        s.S[i * s.modes + i] += over * c[i];
        s.S_inverse[i] = 1.0 / s.S[i * s.modes + i];
      }
      return;
    }
    for (int i = 0; i < s.modes * s.modes; ++i) {
      s.S[i] += over * c[i];
      s.S_inverse[i] = s.S[i];
    }
    invert(s.S_inverse, s.modes);
  }

  static Rule rule_for(State& s, double w_in_v, const double* a_in_v, const double* a_in_w, int known) {
    Rule rule;
    rule.w_in_v = w_in_v * s.h;
    for (int j = 0; j < known; ++j) {
      rule.a_in_v[j] = a_in_v[j] * s.h * s.h;
      rule.a_in_w[j] = a_in_w[j] * s.h;
    }
    return rule;
  }

  /// to_kink: the surface may have a kink where the step ends, and the wheels are still on this side.
  static void solve_stage(State& s, int stage, bool to_kink) {
    const TaskMethod& method = s.task.method;
    const bool last = stage + 1 == method.stages;
    const double gone = s.start + method.time[stage] * s.ds - (last && to_kink ? Places::beside : 0.0);
    Places::place(s, gone, last ? s.task.influence.channels : s.modes);
    const Rule rule = rule_for(s, method.w_in_v[stage], method.a_in_v[stage], method.a_in_w[stage], stage + 1);
    if (s.task.exact_modes) {
      Motion::free_exact_modes(s);
    } else {
      predict(stage + 1, s.modes, rule, s.q, s.r, s.b, 0, s.q_still, s.r_still);
      Motion::free_modes(s);
    }
    Places::lean_with_bridge(s, s.z);
    for (int v = 0; v < s.task.vehicles; ++v)
      if (s.awake[v] != 0) Motion::free_vehicle(s, v, stage + 1, rule);
    const double ahead = s.ds_before > 0.0 ? method.time[stage] * s.ds / s.ds_before : 0.0;
    for (int v = 0; v < s.task.vehicles; ++v) {
      if (s.awake[v] == 0) continue;
      const TaskVehicle& vehicle = s.task.vehicle[v];
      if (s.touching[v] != 0) {
        Places::place_ahead(s, vehicle);
        Influence::weigh(s, vehicle, s.z, s.free);  // the bridge lifts them by so much less
      }
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + s.task.kind[vehicle.kind].wheels; ++j) {
        const Lane guess = s.end[j] + ahead * s.slope[j];
        s.delta[j] = guess > 0.5 * s.end[j] ? guess : 0.5 * s.end[j];
        s.F[j] = Contacts::law(s, j, s.delta[j], s.k[j]);
      }
    }
    Contacts::solve_contacts(s);
    if (!any(s.failed == fill(0.0))) return;
    for (int v = 0; v < s.task.vehicles; ++v)
      if (s.awake[v] != 0) Motion::take_forces(s, v, stage + 1);
    if (s.task.exact_modes) return Motion::move_exact_modes(s);
    const Lane per_d = 1.0 / s.d;
    for (int i = 0; i < s.modes; ++i) s.b[stage + 1][i] = per_d * (s.z[i] - s.q_still[i] + s.p[i]);
  }

  static void finish_step(State& s) {
    const TaskMethod& method = s.task.method;
    const Rule rule = rule_for(s, method.end_w_in_v, method.end_a_in_v, method.end_a_in_w, method.known);
    const auto end = [&](Lane* x, Lane* w, Lane* const* a, int i) {
      Lane next{}, position = x[i] + rule.w_in_v * w[i], rate = w[i];
      for (int j = 0; j < method.known; ++j) {
        position += rule.a_in_v[j] * a[j][i];
        rate += rule.a_in_w[j] * a[j][i];
        next += method.a_next[j] * a[j][i];
      }
      x[i] = position;
      w[i] = rate;
      a[0][i] = next;
    };
    for (int v = 0; v < s.task.vehicles; ++v) {
      if (s.awake[v] == 0) continue;
      const TaskVehicle& vehicle = s.task.vehicle[v];
      const TaskKind& kind = s.task.kind[vehicle.kind];
      for (int i = vehicle.first_coordinate; i < vehicle.first_coordinate + kind.freedom; ++i) end(s.x, s.w, s.a, i);
      Motion::note_bent(s, v);
      for (int j = vehicle.first_wheel; j < vehicle.first_wheel + kind.wheels; ++j) {
        s.slope[j] = s.delta[j] - s.end[j];
        s.end[j] = s.delta[j];
      }
    }
    if (!s.task.exact_modes)
      for (int i = 0; i < s.modes; ++i) end(s.q, s.r, s.b, i);
    s.ds_before = s.ds;
  }

  State state_;
};

}  // namespace
}  // namespace traverse::lanes
