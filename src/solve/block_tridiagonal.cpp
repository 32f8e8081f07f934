// Copies the diagonal and upper blocks of a symmetric PETSc matrix, and computes linear combinations of three block
// tridiagonal matrices.
#include "solve/block_tridiagonal.hpp"

#include <stdexcept>
#include <string>

#include "base/petsc.hpp"

namespace traverse::solve {
namespace {

/// Copies the rows of a PETSc matrix into the blocks on and above the diagonal.
class RowReader {
 public:
  RowReader(Mat matrix, BlockTridiagonal& out) : matrix_(matrix), out_(out) {
    base::check(MatGetOwnershipRange(matrix, &begin_, nullptr));
  }

  void read(PetscInt local_row) {
    const PetscInt row = begin_ + local_row;
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    base::check(MatGetRow(matrix_, row, &count, &columns, &values));
    PetscInt outside = -1;
    for (PetscInt i = 0; i < count; ++i) {
      if (!place(local_row, columns[i], values[i])) outside = columns[i];
    }
    base::check(MatRestoreRow(matrix_, row, &count, &columns, &values));
    if (outside >= 0) {
      throw std::logic_error("entry (" + std::to_string(row) + ", " + std::to_string(outside) +
                             ") lies outside the block tridiagonal");
    }
  }

 private:
  bool place(PetscInt local_row, PetscInt column, double value) {
    const PetscInt block = out_.block;
    const PetscInt node = (begin_ + local_row) / block;
    const PetscInt neighbour = column / block;
    if (value == 0.0 || neighbour == node - 1) return true;  // below the diagonal: known by symmetry
    if (neighbour != node && neighbour != node + 1) return false;
    const std::ptrdiff_t at =
        ((static_cast<std::ptrdiff_t>(local_row / block) * block) + column % block) * block + local_row % block;
    (neighbour == node ? out_.diagonal : out_.upper)[static_cast<std::size_t>(at)] = value;
    return true;
  }

  Mat matrix_;
  BlockTridiagonal& out_;
  PetscInt begin_ = 0;
};

}  // namespace

BlockTridiagonal::BlockTridiagonal(int block_size, int local_nodes) : block(block_size), nodes(local_nodes) {
  if (block_size < 1 || local_nodes < 0) throw std::logic_error("a block tridiagonal needs blocks of 1 or more");
  const std::size_t entries = static_cast<std::size_t>(nodes) * static_cast<std::size_t>(block * block);
  diagonal.assign(entries, 0.0);
  upper.assign(entries, 0.0);
}

BlockTridiagonal BlockTridiagonal::from(Mat matrix, int block_size) {
  PetscInt rows = 0;
  base::check(MatGetLocalSize(matrix, &rows, nullptr));
  PetscInt begin = 0;
  base::check(MatGetOwnershipRange(matrix, &begin, nullptr));
  if (rows % block_size != 0 || begin % block_size != 0) {
    throw std::logic_error("the matrix rows of a rank are not whole blocks of " + std::to_string(block_size));
  }
  BlockTridiagonal result(block_size, static_cast<int>(rows / block_size));
  RowReader reader(matrix, result);
  for (PetscInt row = 0; row < rows; ++row) reader.read(row);
  return result;
}

void BlockTridiagonal::combine(double a, const BlockTridiagonal& A, double b, const BlockTridiagonal& B, double c,
                               const BlockTridiagonal& C) {
  for (const BlockTridiagonal* other : {&A, &B, &C}) {
    if (other->block != block || other->nodes != nodes) throw std::logic_error("matrices of different shapes");
  }
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    diagonal[i] = a * A.diagonal[i] + b * B.diagonal[i] + c * C.diagonal[i];
  }
  for (std::size_t i = 0; i < upper.size(); ++i) upper[i] = a * A.upper[i] + b * B.upper[i] + c * C.upper[i];
}

}  // namespace traverse::solve
