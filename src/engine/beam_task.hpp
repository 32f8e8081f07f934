// A structure in several runs as plain arrays for the kernel of batches, by elements (beam_kernel.hpp) or by modes
// (modal_kernel.hpp). Nodal unknowns are stored column by column along x; a *row* has one number for each run.
#pragma once

#include "engine/train_task.hpp"

namespace traverse::engine {

inline constexpr int most_unknowns_of_a_column = 8;

/// The matrices' blocks of a column: of its unknowns, and of these with the next column's, each by columns. They are
/// numbers if all runs have the same, otherwise rows.
struct ColumnMatrices {
  const double *mass = nullptr, *damping = nullptr, *stiffness = nullptr;
  bool rows = false;
};

/// M a + C w + K v = P + forces of wheels, with block tridiagonal matrices. An *entry* of a constant vector is a number
/// if all runs share the structure, otherwise a row.
struct BeamTask {
  bool shared = true;                                        // all runs share the structure
  int block = 2, columns = 0;                                // unknowns of a column
  int unknowns = 0;                                          // block*columns, or number of modes
  const ColumnMatrices* column = nullptr;                    // one for each column
  bool proportional = false;                                 // C = by_mass M + by_stiffness K
  const double *by_mass = nullptr, *by_stiffness = nullptr;  // rows: 1/s, s
  const char* held = nullptr;                                // for each unknown: whether a support holds it
  // An entry for each unknown: P, N and N m; by modes the displacements under P, m and rad.
  const double* dead = nullptr;

  // Entries, only by modes, otherwise null: the modes' values at every nodal unknown; 2 sigma, 1/s, and omega^2, 1/s2.
  const double *shape = nullptr, *modal_damping = nullptr, *modal_stiffness = nullptr;
  char* under_wheels = nullptr;   // for each column: ModalRows::set_window
  double* modal_stage = nullptr;  // a row for each mode: its coordinate under the forces of the last pass

  // J = M + rate C + displacement K as J_i = F_i J_(i -+ 1) + ..., eliminated from both ends to the middle column:
  // inverse pivots, and the factor of every pair of neighbours, blocks of rows by columns. The window of columns from
  // first to last includes the middle.
  int first = 0, middle = 0, last = 0;
  double *pivot = nullptr, *factor = nullptr;
  double* inverse = nullptr;  // inverse of J within the band: a block for each column, then one for each pair

  // A row for each unknown: m, rad and their rates. v_stage and work always have nodal unknowns.
  double *v = nullptr, *w = nullptr, *a[most_kept] = {};
  double *v_predicted = nullptr, *w_predicted = nullptr;
  double* v_stage = nullptr;   // displacements under the forces of the last pass: TrainTask::nodal
  double* residual = nullptr;  // P - C w - K v of the predicted state
  double* solution = nullptr;  // accelerations of the stage, without the part in BeamRows::find_residual
  double* work = nullptr;      // loads, then solutions
  // The upper half of the compliance matrix of every element at its transverse unknowns, row by row; off-diagonal
  // entries twice: 10 rows for each element.
  double* compliance = nullptr;
  int elements = 0, transverse[2] = {0, 1};  // indices of v and theta in a column
  const int* first_column = nullptr;         // first column of each element
};

}  // namespace traverse::engine
