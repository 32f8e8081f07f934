// A train of linear vehicles on its structure as plain arrays: the only thing that the kernel (train_kernel.hpp), which
// is compiled once for each kind of processor, sees of the rest of the program.
//
// Vehicles with as many coordinates and wheels stand in blocks, one in each lane of the processor's vectors; a *row*
// has a number of each lane (best_width() of processor.hpp). A lane without a vehicle has the mass 1 and wheels that
// touch nothing.
#pragma once

namespace traverse::engine {

inline constexpr int most_lanes = 8;
inline constexpr int most_stages = 5, most_kept = 6;  // implicit stages of a method, accelerations that it combines
inline constexpr int most_nodal = 6;                  // unknowns of an element
inline constexpr int most_wheels = 64;                // of a vehicle

/// A sparse matrix: entry i stands in row[i] and column[i], its value is a row.
struct SparseRows {
  int count = 0;
  const int *row = nullptr, *column = nullptr;
  const double* value = nullptr;
};

/// Two sparse matrices with as many entries in each row, which stand in the same columns: [row][width]. What a row has
/// fewer is 0 in column 0, so that no loop ends sooner or later than the one before.
struct PairedRows {
  int width = 0;
  const int* column = nullptr;
  const double *first = nullptr, *second = nullptr;  // values, rows
};

/// Vehicles M x'' + C x' + K x + r0 + drive s'' = G^T f_up + G_along^T f_along, with the forces f on their wheels.
/// Matrices by rows of `freedom` columns; units N, m, rad, s.
struct VehicleBlock {
  int freedom = 0, wheels = 0;
  int first_coordinate = 0, first_wheel = 0;  // among all rows of coordinates, of wheels
  const double *M = nullptr, *r0 = nullptr;
  SparseRows C, K, G, G_along;       // G, G_along: row: the wheel, column: the coordinate
  PairedRows K_and_C, both_G;        // the same again: K and C; G and G_along
  const double* driven = nullptr;    // row by coordinate: driven x'' is the power that holds the masses' speed, N s
  const double* speed = nullptr;     // a row: m/s, of the steady motion
  const double* drive = nullptr;     // a row: the same where the speed is prescribed, else 0
  const double* distance = nullptr;  // a row: m, travelled at the stage's time
  int alike = -1;                    // an earlier block of the same numbers, whose matrices below are used; -1: none
  const char* active = nullptr;      // whether it moves: else it stands still, and nothing of it is computed
  double* inverse = nullptr;         // (M + rate C + displacement K)^-1
  double *Y = nullptr, *Y_along = nullptr;  // freedom x wheels: inverse G^T, inverse G_along^T
  double* H =
      nullptr;  // 4 x wheels x wheels: displacement of wheels per force: up by up, up by along, along by up, ...
};

/// How the slots of a row are: somewhere, one behind the other, or all of rigid ground.
enum Together { apart = 0, in_line = 1, grounded = 2 };

/// The piece of surface under a wheel, a row each: an element of the structure, or rigid ground.
struct SurfacePatch {
  int* slot = nullptr;                                            // where the element's values are in TrainTask::nodal
  int* together = nullptr;                                        // one a row: Together
  double *x = nullptr, *length = nullptr, *per_length = nullptr;  // of the element, m, m, 1/m
  double* shear = nullptr;                                        // 12 EI/(GA length^2)
  double* flexibility = nullptr;           // length^3/(3 EI), m/N, where the element bends between its nodes
  double *low = nullptr, *high = nullptr;  // m: stations between which the piece reaches
  // Displacement of (v, theta) of the element's nodes per force and moment on them: the upper half of a symmetric
  // matrix, row by row; those beside the diagonal twice.
  double* compliance[10] = {};
};

/// Scaled to the length of a step, a row each.
struct alignas(8 * most_lanes) StageRows {
  double w_in_v[most_lanes], a_in_v[most_kept][most_lanes], a_in_w[most_kept][most_lanes];
  double rate[most_lanes], displacement[most_lanes];
  double guess[most_stages + 2][most_lanes];  // weights of the contact forces at the stages before and at two ends
};

struct TrainTask {
  int stages = 0, known = 0;
  double extrapolation = 0.0;  // of the time between the last two stages: from the last one to the coming one
  StageRows stage[most_stages], end;
  double a_next[most_kept] = {};

  int blocks = 0, coordinates = 0, wheels = 0;  // rows of coordinates, of wheels
  const VehicleBlock* block = nullptr;

  // Of every coordinate.
  double *x = nullptr, *w = nullptr, *a[most_kept] = {}, *w_predicted = nullptr, *a_free = nullptr;

  // Of every wheel, constant.
  const double *place = nullptr, *height = nullptr;      // m: x of its centre, y of its lowest point, at the start
  const double *radius = nullptr, *stiffness = nullptr;  // m; N/m^1.5 or N/m
  const double* per_scale = nullptr;                     // 1/N: one over what errors of forces count by
  const char* hertz = nullptr;                           // one a row: the former
  // Of every wheel, in a stage.
  double *up = nullptr, *along = nullptr;  // m: the same without contact forces
  double *from = nullptr, *to = nullptr;   // m: stations between which its patches are the ones that it has
  const char* second = nullptr;            // one a row: a wheel of it may touch the second patch
  const char* level = nullptr;             // one a row: its wheels' track is level
  // The track's profile, its slope and curvature at `looked_up`, m.
  double *h = nullptr, *h_x = nullptr, *h_xx = nullptr, *looked_up = nullptr;
  double *normal = nullptr, *root = nullptr;             // N; the Hertz law's square root of the penetration
  double *normal_up = nullptr, *normal_along = nullptr;  // the direction from the surface to the centre
  double *force_up = nullptr, *force_along = nullptr;    // N, on the wheel
  double *turn = nullptr, *seat = nullptr;               // rotation of the section under it; m/N of the element inside
  double *ahead = nullptr, *station = nullptr;           // m: of the contact before the centre; x of it
  double* ahead_before = nullptr;                        // m: at the stage before the last one
  double *penetration = nullptr, *penetration_rate = nullptr;  // m, m/s
  double *up_rate = nullptr, *along_rate = nullptr;            // m/s, of the centre
  double* largest = nullptr;                                   // N: of the stages of the step
  double* history[most_stages + 2] = {};  // N: normal forces of the stages, of the step's start and of the one before
  int* active = nullptr;                  // the patch that is touched
  SurfacePatch patch[2];

  // The structure where wheels may be. Unknown k of an element is at its slot and offset[k].
  int per_node = 2;                                      // unknowns of a node that an element sees
  int offset[most_nodal] = {}, ground = 0;               // the slot of rigid ground, whose values are 0
  double surface_height = 0.0;                           // m, of the surface above the axis
  bool shears = false;                                   // some of its elements do
  const double *nodal = nullptr, *nodal_rate = nullptr;  // m, rad and their rates
  double* load = nullptr;                                // N, N m

  // A row of every block: 1 in lanes where another pass would change no force by more than `tolerance` of its scale, as
  // the vehicle stands on rigid ground alone; null: nobody asks.
  double* settled = nullptr;
  double tolerance = 0.0;

  // Of every stage, a row: W lost in dampers, and what the drives give; null: nobody asks.
  double *lost = nullptr, *given = nullptr;
};

}  // namespace traverse::engine
