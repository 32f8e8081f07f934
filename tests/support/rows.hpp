// This rank's rows of a PETSc matrix as plain numbers, for tests.
#pragma once

#include <vector>

#include "base/petsc.hpp"

namespace traverse::test {

/// Dense rows with all columns; empty for a null matrix.
inline std::vector<std::vector<double>> local_rows(Mat matrix) {
  if (matrix == nullptr) return {};
  PetscInt first = 0, past = 0, columns = 0;
  base::check(MatGetOwnershipRange(matrix, &first, &past));
  base::check(MatGetSize(matrix, nullptr, &columns));
  std::vector<std::vector<double>> rows;
  for (PetscInt i = first; i < past; ++i) {
    rows.emplace_back(columns, 0.0);
    PetscInt count = 0;
    const PetscInt* where = nullptr;
    const PetscScalar* values = nullptr;
    base::check(MatGetRow(matrix, i, &count, &where, &values));
    for (PetscInt j = 0; j < count; ++j) rows.back()[where[j]] = values[j];
    base::check(MatRestoreRow(matrix, i, &count, &where, &values));
  }
  return rows;
}

/// The number of stored entries of a local row, including explicit zeros.
inline int stored(Mat matrix, PetscInt row) {
  PetscInt count = 0;
  base::check(MatGetRow(matrix, row, &count, nullptr, nullptr));
  const int result = count;
  base::check(MatRestoreRow(matrix, row, &count, nullptr, nullptr));
  return result;
}

}  // namespace traverse::test
