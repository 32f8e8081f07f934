// What a group of passages of moving forces side by side is computed from, as plain arrays: the only thing that the
// kernels see of the rest of the program (moving_force_batch.hpp).
#pragma once

namespace traverse::modal_engine {

/// What the responses do where a force passes a break of the influence lines.
enum class ForceEvent : char {
  smooth,    // nothing that peaks could be at
  kinks,     // some responses have a kink or a jump
  all_kink,  // the modes' forces have a kink
  all_jump   // the modes' forces jump
};

struct ForceTask {
  int width = 0;                                  // 2, 4 or 8
  int runs = 0;                                   // of these; the lanes beyond repeat the last one
  const double *speed = nullptr, *end = nullptr;  // lanes: m/s, m travelled when the run ends
  double ds = 0.0;                                // m between two instants
  double instant = 0.0;                           // s: the longest that takes in any lane

  // integrate::ForceHistory: sums of all forces, [interval][power][channel] of the distance since the interval's start.
  // Modal forces first; then each probe's deflection less the modes' share of it, then each probe's moment.
  long intervals = 0;
  int channels = 0;
  const double *start = nullptr, *coefficients = nullptr;
  const ForceEvent* event = nullptr;  // at the start of each interval
  const int* first_kink = nullptr;    // of each interval among `kink`, and the number of all
  const int* kink = nullptr;          // responses: deflection of each probe, acceleration of each, moment of each

  int modes = 0;
  const double *omega2 = nullptr, *damping = nullptr;  // of each mode: omega^2, 2 sigma
  const double* q = nullptr;                           // at the start
  int probes = 0;
  const double *deflection = nullptr, *moment = nullptr, *moment_by_rate = nullptr;  // [mode][probe], ModalProbes
  const double* moment_by_acceleration = nullptr;
  const double* weight = nullptr;  // deflection of each probe by the beam's own weight, then moment of each

  bool (*going)(void* whom) = nullptr;  // asked now and then; once it says no, the run stops and its results are void
  void* whom = nullptr;

  // Results, lanes: of each probe deflection, acceleration and moment.
  double *peak = nullptr, *peak_time = nullptr;  // s
  double* work = nullptr;                        // as many numbers as work_size() says, aligned as a lane
};

}  // namespace traverse::modal_engine
