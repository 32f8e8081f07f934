// Runs side by side as plain arrays: the train and the structure of all of them (train_task.hpp, beam_task.hpp), the
// surface that its wheels run on, and what is seen. Lane l of every row belongs to run l; all runs take their steps by
// distance, so that wheels meet ends of spans, kinks and probes in the same step.
#pragma once

#include "base/extremum.hpp"
#include "engine/beam_task.hpp"
#include "engine/surface_table.hpp"

namespace traverse::engine {

/// Heights of the track: cubics between equidistant stations.
struct HeightTable {
  int stations = 0;                    // 0: level
  bool shared = true;                  // all runs have one track
  double start = 0.0, distance = 1.0;  // m
  const double* values = nullptr;  // [station][height, slope*distance], m: numbers, or rows where they are not shared
};

/// How a station responds: linear forms of `count` unknowns of the structure (beam::StationForms).
struct ProbeForms {
  int count = 0;
  const int* unknown = nullptr;
  const double* deflection[3] = {};      // of v, w and a, m
  const double* acceleration = nullptr;  // of a, m/s2
  const double* nodal_moment = nullptr;  // of v, N m
  const double* moment[3] = {};          // what else of the moment follows from v, w and a, N m
  double constant[2] = {};               // of its own weight and temperature: deflection, moment
  double from = 1.0, to = 0.0, x = 0.0;  // m: of the element, if wheels run on it; of the station
  /// What a force or a moment at xi of the element adds, left and right of the station, to the deflection and to the
  /// moment: by powers of xi.
  static constexpr int powers = 6;
  double inside[2][2][2][powers] = {};
};

inline constexpr int looks_kept = base::samples_kept;

/// What is seen of the runs from step to step: rows of the latest instants, peaks.
struct PeakState {
  long known = 0, sampling_interval = 0;         // instants since the last kink of moments, and since the start
  double gone[looks_kept] = {};                  // m: travelled
  double* seen[looks_kept] = {};                 // [deflections, accelerations, moments, rates of moments]
  double* force[looks_kept] = {};                // normal, of all wheels
  double* peak = nullptr;                        // [deflections, accelerations, moments]: magnitudes
  double* peak_time = nullptr;                   // s
  double *least = nullptr, *greatest = nullptr;  // N: a row
  double* lost_at = nullptr;                     // of every wheel, s: when it lost contact; below 0: it touches
  double *losses = nullptr, *longest = nullptr;  // a row: how many wheels lost contact, and for how long at most, s
  double *inner = nullptr, *lagging = nullptr;  // of every probe: what loads and inertia add to the moment, and what of
                                                // it has reached the elastic forces (viscous_lag.hpp)
  double lag = 0.0;                             // s
  double* departure = nullptr;                  // of every block: the root of its linearisation residual at most
  double* farthest = nullptr;                   // coordinates then
};

enum Trouble { none = 0, below_surface = 1, not_converged = 2, not_finite = 3 };

struct BatchTask {
  TrainTask* train = nullptr;
  BeamTask* beam = nullptr;
  const double *speed = nullptr, *end_time = nullptr;  // rows: m/s, s
  const SurfaceTable* surface = nullptr;
  const int* table = nullptr;  // of every wheel's number: its surface
  int* there = nullptr;        // where in it the wheel is
  HeightTable heights;
  double* const* distance = nullptr;  // a row of every block: VehicleBlock::distance
  char* second = nullptr;             // TrainTask::second
  double* failed = nullptr;           // a row: Trouble
  double* work = nullptr;             // two rows a coordinate

  int probes = 0, kinks = 0;
  const ProbeForms* probe = nullptr;
  const double* kink = nullptr;   // m: stations at which the surface has a corner, ascending
  const double* roots = nullptr;  // of every coordinate, a row: what it departs by
  PeakState* look = nullptr;
};

}  // namespace traverse::engine
