// All that the crossing of a group of trains has (crossing_kernel.hpp), number by number and lane by lane.
#pragma once

#include "lanes/crossing_algebra.hpp"

namespace traverse::lanes {
namespace {

template <int W>
struct CrossingState {
  using Lane = typename Lanes<W>::Lane;
  using Mask = typename Lanes<W>::Mask;

  struct Kind {
    Lane *inverse, *by_state;  // J^-1; J^-1 [K C], freedom x 2 freedom
    Lane* alone;               // -J^-1 r0
    Lane *Y, *Y_along, *H;     // J^-1 G^T (freedom x wheels), the same for forces along the track, d G J^-1 G^T
    Lane* M_inverse;           // of all steps
  };

  explicit CrossingState(const Task& of) : task(of), modes(of.modes) {}

  const Task& task;
  const int modes;
  long used = 0;          // lanes of the work memory
  Kind* kinds = nullptr;  // of every kind of vehicle, at this step length

  // The step: m/s, s; its length h and what the method makes of it, s, s2; lanes that have failed (Trouble).
  Lane speed{}, end_time{}, h{}, rate{}, d{}, failed{};
  double ds = 0.0, ds_before = 0.0, start = 0.0, distance = 0.0;  // m: lengths, begin of the step, end of the last one

  // Vehicles, [coordinate]: x, x', x~ and x'~ of a vehicle behind each other, x'' without contacts and at the stages.
  Lane *x = nullptr, *w = nullptr, *still = nullptr, *a_free = nullptr;
  Lane* a[most_kept] = {};
  Lane *bent = nullptr,
       *most_bent = nullptr;  // coordinates where a vehicle was farthest from linear; how far [vehicle]
  char *awake = nullptr, *touching = nullptr;  // [vehicle]: moves; has a wheel on the bridge

  // Modes, [mode]: q, q', q~, q'~, without contacts, what contacts add, q'' at the stages.
  Lane *q = nullptr, *r = nullptr, *q_still = nullptr, *r_still = nullptr, *z = nullptr, *p = nullptr;
  Lane* b[most_kept] = {};
  Lane *omega2 = nullptr, *load = nullptr;  // 1/s2; modal forces of the moving forces
  Lane *S = nullptr, *S_inverse = nullptr, *factor = nullptr, *rhs = nullptr, *scaled = nullptr;  // [mode][mode]; work
  Lane *to_q = nullptr, *to_r = nullptr;  // of exact modes: [mode][q, q', force before, force after]

  // Wheels, [wheel]. m: penetration over a level surface with the vehicle at rest, now, without contact forces, at the
  // end of the last step, and how it grew in that; N, N/m: force and tangent.
  Lane *offset = nullptr, *delta = nullptr, *free = nullptr, *end = nullptr, *slope = nullptr;
  Lane *F = nullptr, *k = nullptr,
       *lean = nullptr;                    // lean: the slope of the surface, which the contact's normal follows
  double *g = nullptr, *load_g = nullptr;  // influence at each wheel and moving force: [wheel][channel]
  double* g_slope = nullptr;               // how the modes' rises, 1/m: [wheel][mode]
  // Of the wheels: the slope of the bridge alone; m: how far each has moved along the track.
  Lane *lean_of_bridge = nullptr, *along = nullptr;
  // The modes' where the wheel touches the bridge: [wheel][mode].
  Lane* g_ahead = nullptr;
  int *piece = nullptr, *load_piece = nullptr;  // of it, that each is on
  char *on = nullptr, *load_on = nullptr;       // whether it is on the bridge

  // The contacts' solution: what pushing the bridge by a force changes another one by, and how much forces have changed
  // since; lanes whose contacts are solved all together at this step length; 1/k and L D L^T of D = 1/k + H of each
  // vehicle, residuals, L^-1 g [wheel][mode].
  Lane yield_to_force{}, moved{};
  Mask hard{};
  Lane *yield = nullptr, *D = nullptr, *pivot = nullptr, *residual = nullptr, *reduced = nullptr;
  long* D_begin = nullptr;

  // What is seen: instants since the last kink of moments, since the start, of wheels, kept; the distances
  // of the last five instants, responses there [deflections, accelerations, moments of the probes, rates of the
  // latter], and wheel forces.
  long known = 0, looks = 0, seen = 0, kept = 0;
  double s_seen[5] = {};
  Lane *row_of[5] = {}, *F_seen[5] = {};
  // What modes left out do at the probes (CrossingLeftOut), [deflections, moments]: what forces bend them to at this
  // instant and the one before, how fast that rose, where they are and how fast they move; what a step makes of [both
  // at its start, what they follow at its start and end] of deflections and keeps of moments; the step before, s;
  // whether a step begins where there may be a kink.
  Lane* bent_to[2] = {};
  Lane *bend_rate = nullptr, *left = nullptr, *left_rate = nullptr;
  Lane to_left[4] = {}, to_left_rate[4] = {}, left_keeps{}, h_before{};
  bool behind_kink = false;
  Lane *peak = nullptr, *peak_time = nullptr, least{}, greatest{}, edge{};  // the last one: CrossingResult::edge
};

template <int W>
struct CrossingMemory {
  using State = CrossingState<W>;
  using Kind = typename State::Kind;
  using Lane = typename State::Lane;

  /// Sets all pointers into `work`, or, where that is null, counts alone what they take.
  static void lay_out(State& s, double* work) {
    const long n = s.task.coordinates, wheels = s.task.wheels, modes = s.modes, probes = 3L * s.task.probes.count;
    s.kinds = take_from<Kind>(work, s.used, W, s.task.kinds);
    for (int k = 0; k < s.task.kinds; ++k) {
      const long f = s.task.kind[k].freedom, w = s.task.kind[k].wheels;
      const Kind own = {take_from<Lane>(work, s.used, W, f * f), take_from<Lane>(work, s.used, W, 2 * f * f),
                        take_from<Lane>(work, s.used, W, f),     take_from<Lane>(work, s.used, W, f * w),
                        take_from<Lane>(work, s.used, W, f * w), take_from<Lane>(work, s.used, W, w * w),
                        take_from<Lane>(work, s.used, W, f * f)};
      if (work != nullptr) s.kinds[k] = own;
    }
    Lane** const of_coordinates[] = {&s.x, &s.w, &s.a_free, &s.bent};
    for (Lane** own : of_coordinates) *own = take_from<Lane>(work, s.used, W, n);
    s.still = take_from<Lane>(work, s.used, W, 2 * n);
    s.most_bent = take_from<Lane>(work, s.used, W, s.task.vehicles);
    Lane** const of_modes[] = {&s.q, &s.r, &s.q_still, &s.r_still, &s.z, &s.p, &s.omega2, &s.load, &s.rhs, &s.scaled};
    for (Lane** own : of_modes) *own = take_from<Lane>(work, s.used, W, modes);
    for (int j = 0; j < most_kept; ++j) {
      s.a[j] = take_from<Lane>(work, s.used, W, j < s.task.method.known ? n : 0);
      s.b[j] = take_from<Lane>(work, s.used, W, j < s.task.method.known ? modes : 0);
    }
    s.to_q = take_from<Lane>(work, s.used, W, s.task.exact_modes ? 4 * modes : 0);
    s.to_r = take_from<Lane>(work, s.used, W, s.task.exact_modes ? 4 * modes : 0);
    s.S = take_from<Lane>(work, s.used, W, modes * modes);
    s.S_inverse = take_from<Lane>(work, s.used, W, modes * (s.task.coupled ? modes : 1));
    s.factor = take_from<Lane>(work, s.used, W, modes * modes);
    Lane** const of_wheels[] = {&s.offset, &s.delta,    &s.F,     &s.k,    &s.free,           &s.end,  &s.slope,
                                &s.yield,  &s.residual, &s.pivot, &s.lean, &s.lean_of_bridge, &s.along};
    for (Lane** own : of_wheels) *own = take_from<Lane>(work, s.used, W, wheels);
    for (Lane*& own : s.F_seen) own = take_from<Lane>(work, s.used, W, wheels);
    s.D_begin = take_from<long>(work, s.used, W, s.task.vehicles + 1);
    long entries = 0;
    for (int v = 0; v < s.task.vehicles; ++v) {
      const long w = s.task.kind[s.task.vehicle[v].kind].wheels;
      if (work != nullptr) s.D_begin[v] = entries;
      entries += w * w;
    }
    s.D = take_from<Lane>(work, s.used, W, entries);
    s.reduced = take_from<Lane>(work, s.used, W, wheels * modes);
    s.g = take_from<double>(work, s.used, W, wheels * s.task.influence.channels);
    s.g_slope = take_from<double>(work, s.used, W, wheels * modes);
    s.g_ahead = take_from<Lane>(work, s.used, W, wheels * modes);
    s.load_g = take_from<double>(work, s.used, W, static_cast<long>(s.task.loads) * s.task.influence.channels);
    s.piece = take_from<int>(work, s.used, W, wheels);
    s.load_piece = take_from<int>(work, s.used, W, s.task.loads);
    s.on = take_from<char>(work, s.used, W, wheels);
    s.load_on = take_from<char>(work, s.used, W, s.task.loads);
    s.awake = take_from<char>(work, s.used, W, s.task.vehicles);
    s.touching = take_from<char>(work, s.used, W, s.task.vehicles);
    for (Lane*& row : s.row_of) row = take_from<Lane>(work, s.used, W, probes + s.task.probes.count);
    for (Lane*& row : s.bent_to) row = take_from<Lane>(work, s.used, W, probes);
    Lane** const of_left[] = {&s.bend_rate, &s.left, &s.left_rate};
    for (Lane** own : of_left) *own = take_from<Lane>(work, s.used, W, probes);
    s.peak = take_from<Lane>(work, s.used, W, probes);
    s.peak_time = take_from<Lane>(work, s.used, W, probes);
  }
};

}  // namespace
}  // namespace traverse::lanes
