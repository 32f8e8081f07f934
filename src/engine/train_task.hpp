// A train of linear vehicles on its structure as plain arrays: the whole interface between the kernel
// (train_kernel.hpp), which is compiled once for each instruction set, and the other parts of the program; and the
// pieces of running surface under a wheel by the position of its centre, for single runs and batches.
//
// Vehicles with equal numbers of coordinates and wheels form blocks, one vehicle in each SIMD lane; a *row* has one
// number for each lane (best_width() of processor.hpp). A lane without a vehicle has the mass 1 and wheels without
// contact.
#pragma once

namespace traverse::engine {

inline constexpr int most_lanes = 8;
inline constexpr int most_stages = 5, most_kept = 6;  // implicit stages of a method, accelerations that it combines
inline constexpr int most_nodal = 6;                  // unknowns of an element
inline constexpr int most_wheels = 64;                // limit for a vehicle

/// A sparse matrix: entry i has the indices row[i] and column[i], its value is a row.
struct SparseRows {
  int count = 0;
  const int *row = nullptr, *column = nullptr;
  const double* value = nullptr;
};

/// Two sparse matrices with the same columns and the same number of entries in each row: [row][width]. Missing entries
/// of a row are 0 in column 0, so that all loops have the same length.
struct PairedRows {
  int width = 0;
  const int* column = nullptr;
  const double *first = nullptr, *second = nullptr;  // values, rows
};

/// Vehicles M x'' + C x' + K x + r0 + driven s'' = G^T f_up + G_along^T f_along, with the forces f on their wheels.
/// s(t) is the time at a constant speed, otherwise the distance. Matrices by rows of `freedom` columns; units N, m,
/// rad, s.
struct VehicleBlock {
  int freedom = 0, wheels = 0;
  int first_coordinate = 0, first_wheel = 0;  // index among all rows of coordinates, and among all rows of wheels
  const double *M = nullptr, *r0 = nullptr;
  SparseRows C, K, G, G_along;  // G, G_along: row: the wheel, column: the coordinate
  PairedRows K_and_C, both_G;   // the matrices above in pairs: K and C; G and G_along
  // A row for each coordinate, and a row: s' (driven^T x'' + driven_mass s'') is the power that drives the masses.
  const double *driven = nullptr, *driven_mass = nullptr;
  const double* drive = nullptr;  // a row: distance per unit of s if it is prescribed, otherwise 0
  // Rows at the stage's time: s', s''; distance travelled and its rate, m, m/s.
  const double *rate = nullptr, *acceleration = nullptr, *distance = nullptr, *speed = nullptr;
  int same_as = -1;              // an earlier block with equal matrices, whose arrays below are used; -1: none
  const char* active = nullptr;  // whether the block moves: if not, it is at rest and is not computed
  double* inverse = nullptr;     // (M + rate C + displacement K)^-1
  double *Y = nullptr, *Y_along = nullptr;  // freedom x wheels: inverse G^T, inverse G_along^T
  double* H =
      nullptr;  // 4 x wheels x wheels: displacement of wheels per force: up by up, up by along, along by up, ...
};

/// The slots of a row: in any order, contiguous, or all of rigid ground.
enum SlotOrder { scattered = 0, contiguous = 1, all_ground = 2 };

/// The piece of surface under a wheel, in rows: an element of the structure, or rigid ground.
struct SurfacePatch {
  int* slot = nullptr;        // position of the element's values in TrainTask::nodal
  int* slot_order = nullptr;  // one for each row: SlotOrder
  double *x = nullptr, *length = nullptr,
         *per_length = nullptr;            // left end, length and 1/length of the element; m, m, 1/m
  double* shear = nullptr;                 // 12 EI/(GA length^2)
  double* flexibility = nullptr;           // length^3/(3 EI), m/N, if the local compliance is included
  double *low = nullptr, *high = nullptr;  // m: first and last station of the piece
  // Displacement of (v, theta) of the element's nodes per force and moment on them: the upper half of a symmetric
  // matrix, row by row; off-diagonal entries twice.
  double* compliance[10] = {};
};

/// The coefficients of a stage, scaled to the length of a step, in rows.
struct alignas(8 * most_lanes) StageRows {
  double w_in_v[most_lanes] = {}, a_in_v[most_kept][most_lanes] = {}, a_in_w[most_kept][most_lanes] = {};
  double rate[most_lanes] = {}, displacement[most_lanes] = {};
  // Weights of the contact forces at the previous stages and at two starts of steps.
  double guess[most_stages + 2][most_lanes] = {};
};

struct TrainTask {
  int stages = 0, known = 0;
  double extrapolation = 0.0;  // time to the next stage over the time between the last two stages
  StageRows stage[most_stages], end;
  double a_next[most_kept] = {};

  int blocks = 0, coordinates = 0, wheels = 0;  // number of blocks, of rows of coordinates, of rows of wheels
  const VehicleBlock* block = nullptr;

  // A row for every coordinate.
  double *x = nullptr, *w = nullptr, *a[most_kept] = {}, *w_predicted = nullptr, *a_free = nullptr;

  // A row for every wheel, constant.
  const double *place = nullptr, *height = nullptr;      // m: initial x of its centre and y of its lowest point
  const double *radius = nullptr, *stiffness = nullptr;  // m; N/m^1.5 or N/m
  const double* per_scale = nullptr;                     // 1/N: one over the scale of its force
  const char* hertz = nullptr;                           // one for each row: Hertz law, with stiffness in N/m^1.5
  // A row for every wheel, in a stage.
  double *up = nullptr, *along = nullptr;     // m: positions as above, without contact forces
  double *from = nullptr, *to = nullptr;      // m: stations between which its patches are valid
  const char* touches_two_patches = nullptr;  // for each row: whether a wheel may touch the second patch
  const char* level = nullptr;                // one for each row: the track of its wheels is level
  // The track's profile, its slope and curvature at `profile_station`, m.
  double *h = nullptr, *h_x = nullptr, *h_xx = nullptr, *profile_station = nullptr;
  double *normal = nullptr, *root = nullptr;             // N; square root of the penetration by Hertz's law
  double *normal_up = nullptr, *normal_along = nullptr;  // the direction from the surface to the centre
  double *force_up = nullptr, *force_along = nullptr;    // N, on the wheel
  double *turn = nullptr, *local_compliance = nullptr;   // rotation of the section; m/N
  double *ahead = nullptr, *station = nullptr;           // m: distance of the contact ahead of the centre; x of it
  double* ahead_before = nullptr;                        // m: value of `ahead` at the second last stage
  double *penetration = nullptr, *penetration_rate = nullptr;  // m, m/s
  double *up_rate = nullptr, *along_rate = nullptr;            // rates of the centre, m/s
  double *least = nullptr, *largest = nullptr;                 // N: extreme normal forces in the stages of the step
  double* history[most_stages + 2] =
      {};                 // N: normal forces of the stages, at the start of the step and of the previous one
  int* active = nullptr;  // index of the touched patch
  SurfacePatch patch[2];

  // The structure under the wheels. The index of unknown k of an element is its slot plus offset[k].
  int per_node = 2;                                      // unknowns at a node of the wheels' line
  int offset[most_nodal] = {}, ground = 0;               // the slot of rigid ground, whose values are 0
  double surface_height = 0.0;                           // height of the surface above the axis, m
  bool shears = false;                                   // some of its elements have shear
  const double *nodal = nullptr, *nodal_rate = nullptr;  // m, rad and their rates
  double* load = nullptr;                                // N, N m

  // A row for each block: 1 in lanes where another pass would change no force by more than `tolerance` of its scale, if
  // the vehicle is on rigid ground only; null: not used.
  double* converged = nullptr;
  double tolerance = 0.0;

  // For every stage a row: power lost in dampers, power of the drives, W; null: not used.
  double *dissipated = nullptr, *drive_power = nullptr;
};

/// The patches under a wheel whose centre is between two stations.
struct WheelPatches {
  struct Patch {
    int element = -1;                                                                      // -1: rigid ground
    double x = 0.0, length = 1.0, shear = 0.0, flexibility = 0.0, low = 1.0, high = -1.0;  // SurfacePatch
  };
  double from = 0.0, to = 0.0;  // m
  int candidates = 0;
  Patch patch[2];
};

/// The intervals of wheels of one radius, ascending and without gaps from minus to plus infinity.
struct SurfaceTable {
  int count = 0;
  const WheelPatches* patches = nullptr;
};

namespace {

/// The index of the interval with x. The search starts at the previous index k, usually the same or a neighbour.
inline int find_interval(const SurfaceTable& table, double x, int k) {
  constexpr int nearby = 4;
  for (int step = 0; step < nearby && k + 1 < table.count && x > table.patches[k].to; ++step) ++k;
  for (int step = 0; step < nearby && k > 0 && x < table.patches[k].from; ++step) --k;
  int low = x < table.patches[k].from ? 0 : k, high = x > table.patches[k].to ? table.count - 1 : k;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (x > table.patches[middle].to)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/// Sets the patches of a wheel, without their slots and compliances.
inline void set_patches(TrainTask& train, int at, const WheelPatches& patches) {
  train.from[at] = patches.from;
  train.to[at] = patches.to;
  if (train.active[at] >= patches.candidates) train.active[at] = 0;
  for (int n = 0; n < 2; ++n) {
    const WheelPatches::Patch& from = patches.patch[n];
    SurfacePatch& p = train.patch[n];
    p.x[at] = from.x;
    p.length[at] = from.length;
    p.per_length[at] = 1.0 / from.length;
    p.shear[at] = from.shear;
    p.flexibility[at] = from.flexibility;
    p.low[at] = from.low;
    p.high[at] = from.high;
  }
}

}  // namespace

}  // namespace traverse::engine
