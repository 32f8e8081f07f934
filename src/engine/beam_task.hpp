// A structure in several runs as plain arrays for the kernel of batches, by elements (beam_kernel.hpp) or by modes
// (modal_kernel.hpp). Nodal unknowns are stored column by column along x; a *row* has one number for each run.
#pragma once

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
};

}  // namespace traverse::engine
