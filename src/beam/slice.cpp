// Collects the entries of a rank's block tridiagonal rows and creates PETSc AIJ matrices from them, in which rows and
// columns of held unknowns are empty.
#include "slice.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace traverse::beam {

Slice::Slice(int block_size, int first_column, int local_columns)
    : block(block_size), first(first_column), local(local_columns) {
  held_.assign(index((local + 2) * block), 1);
}

void Rows::add(int row, int column, double value) {
  if (std::abs(column / slice_->block - row / slice_->block) > 1)
    throw std::logic_error("unknowns of columns that are not neighbours are coupled");
  values_[place(row, column)] += value;
}

void Rows::add(double factor, const Rows& other) {
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += factor * other.values_[i];
}

void Rows::add_pattern(const Rows& other) {
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += std::abs(other.values_[i]);
}

base::Handle<Mat> Rows::matrix(MPI_Comm comm, const Rows& pattern) const {
  const int b = slice_->block;
  std::vector<PetscInt> starts{0}, columns;
  std::vector<double> values;
  columns.reserve(1);  // PETSc accepts no null pointer
  values.reserve(1);
  for (int row = slice_->first * b; row < (slice_->first + slice_->local) * b; ++row) {
    const int from = (row / b - 1) * b;
    for (int column = std::max(from, 0); column < from + 3 * b && !slice_->held(row); ++column) {
      const std::size_t at = place(row, column);
      if (pattern.values_[at] == 0.0 || slice_->held(column)) continue;
      columns.push_back(column);
      values.push_back(values_[at]);
    }
    starts.push_back(static_cast<PetscInt>(columns.size()));
  }

  base::Handle<Mat> matrix;
  const PetscInt rows = slice_->local * b;
  base::check(MatCreate(comm, matrix.out()));
  base::check(MatSetSizes(matrix, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
  base::check(MatSetType(matrix, MATAIJ));
  // Each of the two calls has an effect on its own kind of matrix only.
  base::check(MatSeqAIJSetPreallocationCSR(matrix, starts.data(), columns.data(), values.data()));
  base::check(MatMPIAIJSetPreallocationCSR(matrix, starts.data(), columns.data(), values.data()));
  base::check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  base::check(MatSetOption(matrix, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return matrix;
}

}  // namespace traverse::beam
