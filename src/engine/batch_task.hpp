// A batch of runs as plain arrays: the train of all runs (train_task.hpp), the structure, by elements (beam_kernel.hpp)
// or by modes, the surface of its wheels, and the observed responses. A row has one number for each SIMD lane; lane l
// belongs to run l. Nodal unknowns are stored column by column along x. All runs have the same steps in distance, so
// that wheels reach ends of spans, kinks and probes in the same step.
#pragma once

#include "base/extremum.hpp"
#include "engine/train_task.hpp"

namespace traverse::engine {

inline constexpr int most_unknowns_of_a_column = 8;
inline constexpr int most_dense = 3;  // up to so many unknowns of a column are all linked with one another
inline constexpr int most_links = most_unknowns_of_a_column * (most_unknowns_of_a_column - 1) / 2;

/// Entries of M, C and K by unknowns: those of unknown i are begin[i] to begin[i + 1] - 1. Entry e couples it with
/// unknown[e]; its values are at value[e], which it shares with the entry on the other side of the diagonal. Without C
/// if it is proportional.
struct MatrixEntries {
  const int *begin = nullptr, *unknown = nullptr, *value = nullptr;
  const double *mass = nullptr, *damping = nullptr, *stiffness = nullptr;
};

/// How a column is eliminated: its unknowns, those that no other column is coupled to first, and the links between them
/// in the factor. Unknowns count from the column's first.
struct ColumnOrder {
  int count = 0, unknown[most_unknowns_of_a_column] = {};
  int links = 0, earlier[most_links] = {}, later[most_links] = {};  // in the order of `later`
};

/// The unknowns of two neighbouring columns that are linked if the further one is eliminated before the nearer one.
struct PairOrder {
  int further_count = 0, further[most_unknowns_of_a_column] = {};
  int nearer_count = 0, nearer[most_unknowns_of_a_column] = {};
};

/// M a + C w + K v = P + forces of wheels; a column is coupled with its neighbours only. An *entry* of a constant
/// vector is a number if all runs share the structure, otherwise a row.
struct BeamTask {
  bool shared = true;                                        // all runs share the structure
  int block = 2, columns = 0;                                // unknowns of a column
  int unknowns = 0;                                          // block*columns, or number of modes
  MatrixEntries equal, different;                            // numbers, equal in all runs; rows
  bool proportional = false;                                 // C = by_mass M + by_stiffness K
  const double *by_mass = nullptr, *by_stiffness = nullptr;  // rows: 1/s, s
  // An entry for each unknown: P, N and N m; by modes the displacements under P, m and rad.
  const double* dead = nullptr;

  // Entries, only by modes, otherwise null: the modes' values at every nodal unknown; 2 sigma, 1/s, and omega^2, 1/s2.
  const double *shape = nullptr, *modal_damping = nullptr, *modal_stiffness = nullptr;
  char* under_wheels = nullptr;   // for each column: ModalRows::set_window
  double* modal_stage = nullptr;  // a row for each mode: its coordinate under the forces of the last pass

  // J = M + rate C + displacement K = L D L^T, eliminated from both ends to the middle column. The window of columns
  // from first to last includes the middle.
  int first = 0, middle = 0, last = 0;
  const ColumnOrder* const* order = nullptr;                              // of each column
  const PairOrder *const *to_right = nullptr, *const *to_left = nullptr;  // of each pair, if the nearer column is there
  double* pivot = nullptr;                                                // rows: 1/D for each unknown, 0 if it is held
  double* factor = nullptr;  // rows of L: those of column c from link_begin[c], of pair c and c + 1 from pair_begin[c],
                             // [nearer][further]
  const int *link_begin = nullptr, *pair_begin = nullptr;
  double* inverse = nullptr;  // inverse of J within the band: a block for each column, then one for each pair

  // A row for each unknown: m, rad and their rates. v_stage and work always have nodal unknowns.
  double *v = nullptr, *w = nullptr, *a[most_kept] = {};
  double *v_predicted = nullptr, *w_predicted = nullptr;
  double* v_stage = nullptr;   // displacements under the forces of the last pass: TrainTask::nodal
  double* residual = nullptr;  // P - C w - K v of the predicted state
  double* solution = nullptr;  // x of BeamRows::find_residual; the stage's accelerations if that is what x is
  double* work = nullptr;      // loads, then solutions
  // The upper half of the compliance matrix of every element at its transverse unknowns, row by row; off-diagonal
  // entries twice: 10 rows for each element.
  double* compliance = nullptr;
  int elements = 0, transverse[2] = {0, 1};  // indices of v and theta in a column
  const int* first_column = nullptr;         // first column of each element

  // A track beside the shear centre, otherwise null: its distance in a row, m. Wheels then use the motion of the track
  // at the nodes of each element, `values` rows from track_row on in v_stage, and load the same rows of work.
  const double* lever = nullptr;
  int track_row = 0, values = 0;
  int place[most_nodal] = {};                 // the element's unknowns, counted from its first column
  int twist[4] = {};                          // likewise those of its twist: twist and rate of both nodes
  int *touched = nullptr, touched_count = 0;  // the elements under wheels
};

/// Heights of the track: cubics between equidistant stations.
struct HeightTable {
  int stations = 0;                    // 0: level
  bool shared = true;                  // all runs have one track
  double start = 0.0, distance = 1.0;  // m
  const double* values = nullptr;      // [station][height, slope*distance], m: numbers if shared, else rows
};

/// The response of a station: linear combinations of `count` unknowns of the structure (recovery::StationForms), whose
/// coefficients are entries (batch_task.hpp).
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
  /// moment: coefficients of the powers of xi, [side][force, moment, torque][deflection, moment][power].
  static constexpr int powers = 6, kinds = 3, inner = 2 * kinds * 2 * powers;
  const double* inside = nullptr;
};

/// A linear combination of rows whose largest magnitude is observed.
struct LinearForm {
  int count = 0;
  const int* row = nullptr;
  const double *coefficient = nullptr, *constant = nullptr;  // entries; null: no constant
};

inline constexpr int kept_samples = base::samples_kept;

/// The observed motion of the runs: rows of the latest samples, peaks.
struct PeakState {
  long samples_since_kink = 0, samples = 0;  // number since the last kink of moments, and since the start
  double distance[kept_samples] = {};        // m
  double* response[kept_samples] = {};       // [deflections, accelerations, moments, rates of moments]
  double* force[kept_samples] = {};          // normal, of all wheels
  double* peak = nullptr;                    // [deflections, accelerations, moments]: magnitudes
  double* peak_time = nullptr;               // s
  double* greatest = nullptr;                // N: a row, of all wheels
  double *at_start = nullptr, *least = nullptr, *least_time = nullptr;  // N, N, s: a row for each wheel
  // m/s2 or rad, s: rows for each of BatchTask::rotation, and for each of BatchTask::car.
  double *rotation = nullptr, *rotation_time = nullptr, *car = nullptr, *car_time = nullptr;
  double* contact_lost_time = nullptr;                                    // s: for each wheel; negative: in contact
  double *contact_loss_count = nullptr, *longest_contact_loss = nullptr;  // rows: 1; s
  // N m, for each probe: moment from loads and inertia inside the element, before and after the lag of b M' damping
  // (recovery/load_movement.hpp).
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

  int probes = 0, kinks = 0, rotations = 0, cars = 0;
  const ProbeForms* probe = nullptr;
  const LinearForm *rotation = nullptr, *car = nullptr;  // of BeamTask::v; of TrainTask::a[0], whose entries are rows
  const double* kink = nullptr;                          // m: stations with a kink of the surface, ascending
  const double* roots = nullptr;                         // a row for each coordinate: train::residual_roots
  PeakState* peaks = nullptr;
};

}  // namespace traverse::engine
