// A structure in several runs as plain arrays: what the batch's kernel (beam_kernel.hpp) sees of it. Its unknowns stand
// column by column along x; a *row* has a number of each run.
#pragma once

#include "engine/train_task.hpp"

namespace traverse::engine {

inline constexpr int most_unknowns_of_a_column = 8;

/// M a + C w + K v = P + forces of wheels, with block tridiagonal matrices that all runs share.
struct BeamTask {
  int block = 2, columns = 0;                                              // unknowns of a column
  const double *mass = nullptr, *damping = nullptr, *stiffness = nullptr;  // [column][2]: blocks by columns, of it and
                                                                           // of its unknowns with those of the next one
  bool proportional = false;                                               // C = by_mass M + by_stiffness K
  double by_mass = 0.0, by_stiffness = 0.0;                                // 1/s, s
  const char* held = nullptr;    // of every unknown: whether a support holds it
  const double* dead = nullptr;  // of every unknown, N and N m: P

  // J = M + rate C + displacement K as J_i = F_i J_(i -+ 1) + ..., eliminated from both ends to the column in the
  // middle: inverse pivots, and the factor of every pair of neighbours, blocks of rows by columns.
  double *pivot = nullptr, *factor = nullptr;
  double* inverse = nullptr;  // of J, within the band: of every column, then of every pair

  // Rows, of every unknown: m, rad and their rates.
  double *v = nullptr, *w = nullptr, *a[most_kept] = {};
  double *v_predicted = nullptr, *w_predicted = nullptr;
  double* v_stage = nullptr;   // under the forces of the last pass: TrainTask::nodal
  double* residual = nullptr;  // P - C w - K v of the predicted state
  double* solution = nullptr;  // of the stage: accelerations, but for what BeamRows::find_residual leaves out
  double* work = nullptr;      // loads, and what solves them
  // The upper half of what every element yields to forces and moments on its transverse unknowns, row by row; those
  // beside the diagonal twice: 10 rows an element.
  double* compliance = nullptr;
  int elements = 0, transverse[2] = {0, 1};  // places of v and theta in a column
  const int* first_column = nullptr;         // of every element
};

}  // namespace traverse::engine
