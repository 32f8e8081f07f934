// A structure in several runs as plain arrays: what the batch's kernel sees of it, by elements (beam_kernel.hpp) or by
// modes (modal_kernel.hpp). Nodal unknowns stand column by column along x; a *row* has a number of each run.
#pragma once

#include "engine/train_task.hpp"

namespace traverse::engine {

inline constexpr int most_unknowns_of_a_column = 8;

/// M a + C w + K v = P + forces of wheels, with block tridiagonal matrices that all runs share.
struct BeamTask {
  int block = 2, columns = 0;                                              // unknowns of a column
  int unknowns = 0;                                                        // block columns, or as many as modes
  const double *mass = nullptr, *damping = nullptr, *stiffness = nullptr;  // [column][2]: blocks by columns, of it and
                                                                           // of its unknowns with those of the next one
  bool proportional = false;                                               // C = by_mass M + by_stiffness K
  double by_mass = 0.0, by_stiffness = 0.0;                                // 1/s, s
  const char* held = nullptr;    // of every unknown: whether a support holds it
  const double* dead = nullptr;  // of every unknown, N and N m: P; by modes its nodal displacements under it, m and rad

  // By modes, else null: their values at every nodal unknown; 2 sigma, 1/s, and omega^2, 1/s2.
  const double *shape = nullptr, *modal_damping = nullptr, *modal_stiffness = nullptr;
  char* under_wheels = nullptr;   // of every column: ModalRows::mark
  double* modal_stage = nullptr;  // a row of every mode: its coordinate under the forces of the last pass

  // J = M + rate C + displacement K as J_i = F_i J_(i -+ 1) + ..., eliminated from both ends to the column in the
  // middle: inverse pivots, and the factor of every pair of neighbours, blocks of rows by columns. The window of
  // columns from first to last has the middle in it.
  int first = 0, middle = 0, last = 0;
  double *pivot = nullptr, *factor = nullptr;
  double* inverse = nullptr;  // of J, within the band: of every column, then of every pair

  // Rows, of every unknown: m, rad and their rates. Those of v_stage and work are nodal in any case.
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
