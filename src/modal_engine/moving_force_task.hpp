// A group of runs, in which moving forces pass the bridge, as plain arrays: the whole interface between the kernels and
// the other parts of the program (moving_force_batch.hpp).
#pragma once

namespace traverse::modal_engine {

struct ForceTask {
  int width = 0;                                  // 2, 4 or 8
  int runs = 0;                                   // number of runs; other lanes repeat the last one
  const double *speed = nullptr, *end = nullptr;  // in lanes: speed, m/s; distance travelled at the end of the run, m
  double ds = 0.0;                                // largest distance between two samples, m
  double instant = 0.0;                           // longest time for this distance in any lane, s
  double least_speed = 0.0;                       // not above the speed of any lane, m/s

  // integrate::ForceHistory: sums of all forces, [interval][power][channel] of the distance since the interval's start.
  // Modal forces first; then each probe's deflection minus the modes' share of it, then each probe's moment.
  long intervals = 0;
  int channels = 0;
  const double *start = nullptr, *coefficients = nullptr;
  // ForceWindows, ForceBounds.
  long stretches = 0;
  const double *stretch_end = nullptr, *stretch_parts = nullptr, *stretch_numbers = nullptr, *move_end = nullptr;
  const long* first_move = nullptr;
  const int* move_length = nullptr;
  int lengths = 0;
  const double* length = nullptr;
  double last_window = 0.0;  // m
  const double* by_amplitude = nullptr;
  bool only_bounds = false;         // the largest bounds are determined instead of the peaks
  const int* first_kink = nullptr;  // for each interval the first index in `kink`; the last entry is the number of all
  const int* kink = nullptr;        // indices of responses: deflections of all probes, then accelerations, then moments

  int modes = 0;
  const double *omega2 = nullptr, *damping = nullptr;  // for each mode: omega^2, 2 sigma
  const double* q = nullptr;                           // initial modal coordinates
  int probes = 0;
  const double *deflection = nullptr, *moment = nullptr, *moment_by_rate = nullptr;  // [mode][probe], ModalProbes
  const double* moment_by_acceleration = nullptr;
  const double* weight =
      nullptr;  // responses under the self-weight: deflections of all probes, then moments of all probes

  bool (*proceed)(void* context) = nullptr;  // called at intervals; if false the run stops, and its results are invalid
  void* context = nullptr;

  // Of each response, lanes: deflection, acceleration and moment of each probe.
  double* peak = nullptr;       // smaller peaks are of no interest; replaced by the peak or the largest bound
  double* peak_time = nullptr;  // s; below 0: there was no greater peak
  double* work = nullptr;       // work_size() numbers, aligned as a lane
};

}  // namespace traverse::modal_engine
