// A batch of runs as plain arrays: the train and the structure of all runs (train_task.hpp, beam_task.hpp), the surface
// of its wheels, and the observed responses. A row has one number for each SIMD lane; lane l belongs to run l. All runs
// have the same steps in distance, so that wheels reach ends of spans, kinks and probes in the same step.
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
  const double* values = nullptr;      // [station][height, slope*distance], m: numbers if shared, else rows
};

/// The response of a station: linear combinations of `count` unknowns of the structure (recovery::StationForms), whose
/// coefficients are entries (beam_task.hpp).
struct ProbeForms {
  int count = 0;
  const int* unknown = nullptr;
  const double* deflection[3] = {};      // m: coefficients of v, w and a
  const double* acceleration = nullptr;  // m/s2: coefficients of a
  const double* nodal_moment = nullptr;  // N m: coefficients of v
  const double* moment[3] = {};          // N m: other parts of the moment, coefficients of v, w and a
  const double* constant = nullptr;      // due to self-weight and temperature: deflection relative to the line through
                                         // the supports, moment
  double from = 1.0, to = 0.0, x = 0.0;  // m: ends of the element, if wheels run on it; station
  /// The contributions of a force or a moment at xi of the element, left and right of the station, to deflection and
  /// moment: coefficients of the powers of xi, [side][force, moment][deflection, moment][power].
  static constexpr int powers = 6, inner = 8 * powers;
  const double* inside = nullptr;
};

inline constexpr int kept_samples = base::samples_kept;

/// The observed motion of the runs: rows of the latest samples, peaks.
struct PeakState {
  long samples_since_kink = 0, samples = 0;      // number since the last kink of moments, and since the start
  double distance[kept_samples] = {};            // m
  double* response[kept_samples] = {};           // [deflections, accelerations, moments, rates of moments]
  double* force[kept_samples] = {};              // normal, of all wheels
  double* peak = nullptr;                        // [deflections, accelerations, moments]: magnitudes
  double* peak_time = nullptr;                   // s
  double *least = nullptr, *greatest = nullptr;  // N: a row
  double* contact_lost_time = nullptr;           // s: for each wheel; negative: in contact
  double *contact_loss_count = nullptr, *longest_contact_loss = nullptr;  // rows: 1; s
  // N m, for each probe: moment from loads and inertia inside the element, before and after the lag of b M' damping
  // (viscous_lag.hpp).
  double *interior_moment = nullptr, *interior_moment_lagged = nullptr;
  bool lags = false;
  const double* lag = nullptr;               // a row: s, above 0 in all lanes if `lags`
  double* largest_residual_root = nullptr;   // for each block: largest upper bound of sqrt(linearisation residual)
  double* coordinates_at_largest = nullptr;  // coordinates of the vehicles at that time
};

enum RunFailure { none = 0, below_surface = 1, not_converged = 2, not_finite = 3 };

struct BatchTask {
  TrainTask* train = nullptr;
  BeamTask* beam = nullptr;
  const double *speed = nullptr, *end_time = nullptr;  // rows: m/s, s
  const SurfaceTable* surface = nullptr;
  const int* table = nullptr;  // index of each wheel's surface
  int* interval = nullptr;     // index of the wheel's interval in its surface
  HeightTable heights;
  double* const* distance = nullptr;    // a row for each block: VehicleBlock::distance
  char* touches_two_patches = nullptr;  // TrainTask::touches_two_patches
  double* failed = nullptr;             // a row: RunFailure
  double* work = nullptr;               // two rows for each coordinate

  int probes = 0, kinks = 0;
  const ProbeForms* probe = nullptr;
  const double* kink = nullptr;   // m: stations with a kink of the surface, ascending
  const double* roots = nullptr;  // a row for each coordinate: train::residual_roots
  PeakState* peaks = nullptr;
};

}  // namespace traverse::engine
