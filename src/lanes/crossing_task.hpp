// What a group of runs side by side is computed from, as plain arrays: the only thing that the kernels, which are
// compiled once for each kind of processor, see of the rest of the program. An entry of a `lanes` array holds `width`
// numbers, one a run.
#pragma once

namespace traverse::lanes {

inline constexpr int most_kept = 6, most_stages = 5;  // accelerations of a method, its implicit stages

/// methods/one_step_methods.hpp, for steps of 1 s.
struct TaskMethod {
  int stages = 0, known = 0;
  double time[most_stages] = {};
  double w_in_v[most_stages] = {};
  double a_in_v[most_stages][most_kept] = {}, a_in_w[most_stages][most_kept] = {};
  double rate = 0.0, displacement = 0.0;  // of every stage
  double end_w_in_v = 0.0, end_a_in_v[most_kept] = {}, end_a_in_w[most_kept] = {}, a_next[most_kept] = {};
  double power[most_kept] = {};  // integral over the step of a power known at the accelerations' states
};

/// Vehicles with the same numbers: M x'' + C x' + K x + r0 = G^T F, of `freedom` coordinates x and `wheels` contact
/// forces F, upward. The wheels move up by G x.
struct TaskKind {
  int freedom = 0, wheels = 0;
  const double *M = nullptr, *C = nullptr, *K = nullptr, *r0 = nullptr, *G = nullptr;  // lanes, matrices by rows
  const double* G_along = nullptr;                  // the wheels move along the track by G_along x
  const int *G_row = nullptr, *G_column = nullptr;  // where G has entries
  const double* bend = nullptr;  // of every coordinate: root of what its square puts the mechanism out of balance by
};

struct TaskVehicle {
  int kind = 0;
  int first_coordinate = 0, first_wheel = 0;
  double rests_until = 0.0;  // m: distance until which it stands still on level ground; 0: moves from the start
};

/// Cubic polynomials of x, as structure::PiecewiseCubic: [piece][power][channel]. The first `modes` channels are the
/// modal forces of a unit downward force there; then each probe's deflection by it less the modes' share of that, then
/// each probe's moment.
struct TaskInfluence {
  int pieces = 0, channels = 0;
  const double *breaks = nullptr, *coefficients = nullptr;
  const double* largest = nullptr;  // magnitude of each mode's
};

/// Heights of the track that a wheel's lowest point follows: cubics between equidistant stations, by values and slopes
/// times the distance: [station][2][lane], or [station][2] where all runs have one track. No stations: level.
struct TaskHeights {
  int stations = 0;
  bool shared = true;
  double start = 0.0, distance = 1.0;
  const double* values = nullptr;
};

struct TaskProbes {
  int count = 0;
  const double *deflection = nullptr, *moment = nullptr, *moment_by_rate = nullptr;  // [mode][probe], ModalProbes
  const double *moment_by_acceleration = nullptr, *deflection_by_rate = nullptr;     // the latter may be null
};

/// The mode that stands for those left out, 1/s2 and 1/s, and by how much they lag without inertia, s: CrossingLeftOut.
/// No lag: they are at rest under the forces as these are.
struct TaskLeftOut {
  double omega2 = 0.0, damping = 0.0, lag = 0.0;
};

/// A stretch of equal steps.
struct TaskStretch {
  double to = 0.0;  // m travelled since t = 0
  long steps = 0;
  bool kink = true;    // a force may have one at its end
  bool keeps = false;  // accelerations at its end are kept
};

struct Task {
  int width = 0;
  const double *speed = nullptr, *end_time = nullptr;  // lanes: m/s, s
  TaskMethod method;

  int kinds = 0, vehicles = 0, wheels = 0, coordinates = 0;
  const TaskKind* kind = nullptr;
  const TaskVehicle* vehicle = nullptr;
  const double* x = nullptr;            // m: of every wheel at t = 0
  const double* penetration = nullptr;  // lanes: of every wheel then, m
  const double* stiffness = nullptr;    // lanes: of its contact, N/m^1.5 or N/m
  const char* hertz = nullptr;          // whether it is the former
  double force_scale = 0.0;             // N: what contact forces are judged by
  double radius = 0.0;                  // m: of all wheels
  const double* arm = nullptr;          // m: from each wheel's centre down to the track at rest
  const double* x_rate = nullptr;       // lanes: of every coordinate at t = 0, m/s or rad/s

  int loads = 0;                                    // moving forces
  const double *load_x = nullptr, *load = nullptr;  // m; lanes: N, downward

  int modes = 0;
  const double *omega2 = nullptr, *damping = nullptr;  // lanes: squares; 2 sigma, or of coupled modes the matrix
  bool coupled = false;
  bool exact_modes = false;   // move exactly under forces that are linear over a step; of methods of one solve
  const double* q = nullptr;  // lanes: at t = 0
  TaskInfluence influence;
  TaskHeights heights;
  TaskProbes probes;
  TaskLeftOut left_out;

  int stretches = 0;
  const TaskStretch* stretch = nullptr;
  int kinks = 0;
  const double* kink = nullptr;  // m: stations at which the surface has a corner, ascending

  // Results, lanes: of each probe deflection, acceleration and moment; of all wheels.
  double *peak = nullptr, *peak_time = nullptr;
  double *least_force = nullptr, *greatest_force = nullptr;
  double* kept = nullptr;    // accelerations of the probes at the start and where stretches keep them; null: not kept
  double* bent = nullptr;    // coordinates of every vehicle where it was farthest from linear
  double* edge = nullptr;    // CrossingResult::edge
  double* failed = nullptr;  // 0: none of what follows
  double* work = nullptr;    // as many numbers as work_size() says, aligned as a lane
};

enum Trouble { none = 0, contact_lost = 1, not_converged = 2, not_finite = 3 };

}  // namespace traverse::lanes
