// The matrix of the solver's benchmarks: a bridge of 30 m spans on rigid supports, ten cubic beam elements a span,
// A = a^2 M + K with a = 2,000 1/s (a step of 1 ms), or a = 0.
#pragma once

#include <petscmat.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/petsc.hpp"
#include "solve/block_tridiagonal.hpp"

namespace traverse::benchmarks {

constexpr int elements_a_span = 10;

/// Entry (i, j) of an element's a^2 M + K; its unknowns: deflection and rotation at the left, at the right.
inline double element_entry(double shift, int i, int j) {
  constexpr double length = 3.0;                // m
  constexpr double bending_stiffness = 2.5e10;  // N m^2
  constexpr double mass = 1e4;                  // kg/m
  constexpr std::array<std::array<double, 4>, 4> stiffness = {
      {{12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}}};
  constexpr std::array<std::array<double, 4>, 4> inertia = {
      {{156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}}};
  const auto r = static_cast<std::size_t>(i);
  const auto c = static_cast<std::size_t>(j);
  const double rotations = (i % 2 == 1 ? length : 1.0) * (j % 2 == 1 ? length : 1.0);
  return rotations * (bending_stiffness / (length * length * length) * stiffness[r][c] +
                      shift * shift * mass * length / 420.0 * inertia[r][c]);
}

struct Bridge {
  solve::BlockTridiagonal matrix;
  std::vector<char> fixed;
};

/// This rank's nodes [begin, begin + nodes) of a bridge with one node more on either side. A node's unknowns beyond
/// deflection and rotation are chains of springs.
inline Bridge bridge(int block, int begin, int nodes, bool last, double shift) {
  Bridge result{solve::BlockTridiagonal(block, nodes), std::vector<char>(static_cast<std::size_t>(nodes * block), 0)};
  for (int node = 0; node < nodes; ++node) {
    double* diagonal = result.matrix.diagonal.data() + static_cast<std::ptrdiff_t>(node) * block * block;
    double* upper = result.matrix.upper.data() + static_cast<std::ptrdiff_t>(node) * block * block;
    for (int j = 0; j < block; ++j) {
      for (int i = 0; i < block; ++i) {
        const bool bending = i < 2 && j < 2;
        if (bending) diagonal[j * block + i] = element_entry(shift, i, j) + element_entry(shift, i + 2, j + 2);
        if (bending) upper[j * block + i] = element_entry(shift, i, j + 2);
        if (!bending && i == j) diagonal[j * block + i] = 4e9;
        if (!bending && i == j) upper[j * block + i] = -1.5e9;
        if (last && node + 1 == nodes) upper[j * block + i] = 0.0;
      }
    }
    if ((begin + node) % elements_a_span == 0) result.fixed[static_cast<std::size_t>(node * block)] = 1;
  }
  return result;
}

/// Entry of the matrix on or above the diagonal, with the fixed unknowns as identity; within two neighbouring nodes.
inline double entry(const Bridge& parts, PetscInt row, PetscInt column) {
  const PetscInt block = parts.matrix.block;
  const PetscInt node = row / block;
  if (parts.fixed[static_cast<std::size_t>(row)] != 0 || parts.fixed[static_cast<std::size_t>(column)] != 0) {
    return row == column ? 1.0 : 0.0;
  }
  const std::vector<double>& blocks = column / block == node ? parts.matrix.diagonal : parts.matrix.upper;
  return blocks[static_cast<std::size_t>((node * block + column % block) * block + row % block)];
}

/// body(row, column, value) for the entries on and above the diagonal, of the blocks that are not all zero.
template <class Body>
void for_upper_entries(const Bridge& parts, Body body) {
  const PetscInt block = parts.matrix.block;
  const PetscInt rows = static_cast<PetscInt>(parts.fixed.size());
  for (PetscInt row = 0; row < rows; ++row) {
    const PetscInt past = std::min<PetscInt>(rows, (row / block + 2) * block);
    for (PetscInt column = row; column < past; ++column) body(row, column, entry(parts, row, column));
  }
}

/// The matrix as PETSc's SBAIJ, its upper half.
inline base::Handle<Mat> symmetric_matrix(const Bridge& parts) {
  const PetscInt rows = static_cast<PetscInt>(parts.fixed.size());
  base::Handle<Mat> matrix;
  base::check(MatCreateSeqSBAIJ(PETSC_COMM_SELF, 1, rows, rows, 2 * parts.matrix.block, nullptr, matrix.out()));
  for_upper_entries(parts, [&](PetscInt row, PetscInt column, double value) {
    base::check(MatSetValue(matrix, row, column, value, INSERT_VALUES));
  });
  base::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  base::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  return matrix;
}

}  // namespace traverse::benchmarks
