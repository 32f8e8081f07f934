// The factorisation as a PETSc preconditioner: one application solves a beam's matrix to rounding, on any ranks.

#include "solve/beam_preconditioner.hpp"

#include <gtest/gtest.h>
#include <petscksp.h>

#include <stdexcept>

#include "base/petsc.hpp"
#include "support/random_bands.hpp"

namespace {

using namespace traverse;
using base::check;
using base::Handle;

constexpr int nodes_a_rank = 400;

/// factor * (a^2 M + K) of a clamped beam of elements of 3 m, or with `unsupported` K alone without its clamp.
Handle<Mat> beam_matrix(double factor, bool supported) {
  Handle<Mat> matrix;
  check(MatCreate(PETSC_COMM_WORLD, matrix.out()));
  check(MatSetSizes(matrix, 2 * nodes_a_rank, 2 * nodes_a_rank, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(matrix, MATAIJ));
  check(MatSetBlockSize(matrix, 2));
  check(MatSeqAIJSetPreallocation(matrix, 6, nullptr));
  check(MatMPIAIJSetPreallocation(matrix, 6, nullptr, 6, nullptr));
  PetscInt rows = 0, begin = 0, past = 0;
  check(MatGetSize(matrix, &rows, nullptr));
  check(MatGetOwnershipRange(matrix, &begin, &past));
  const double h = 3.0;
  Eigen::Matrix4d K, M;
  K << 12, 6 * h, -12, 6 * h, 6 * h, 4 * h * h, -6 * h, 2 * h * h, -12, -6 * h, 12, -6 * h, 6 * h, 2 * h * h, -6 * h,
      4 * h * h;
  M << 156, 22 * h, 54, -13 * h, 22 * h, 4 * h * h, 13 * h, -3 * h * h, 54, 13 * h, 156, -22 * h, -13 * h, -3 * h * h,
      -22 * h, 4 * h * h;
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> element =
      factor * (2.5e10 / (h * h * h) * K + (supported ? 4e6 * 1e4 * h / 420.0 : 0.0) * M);
  for (PetscInt row = begin; row < past && row + 2 < rows; row += 2) {
    const PetscInt unknowns[] = {row, row + 1, row + 2, row + 3};
    check(MatSetValues(matrix, 4, unknowns, 4, unknowns, element.data(), ADD_VALUES));
  }
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  return matrix;
}

Handle<KSP> solver(Mat matrix) {
  Handle<KSP> ksp;
  check(KSPCreate(PETSC_COMM_WORLD, ksp.out()));
  check(KSPSetType(ksp, KSPPREONLY));
  PC pc = nullptr;
  check(KSPGetPC(ksp, &pc));
  solve::use_beam_factorisation(pc);
  check(KSPSetOperators(ksp, matrix, matrix));
  return ksp;
}

/// The norm of b - A x relative to that of b.
double residual(KSP ksp, Mat matrix) {
  Handle<Vec> x, b, difference;
  check(MatCreateVecs(matrix, x.out(), b.out()));
  check(VecDuplicate(b, difference.out()));
  check(VecSet(b, 1e6));
  check(KSPSolve(ksp, b, x));
  check(MatMult(matrix, x, difference));
  check(VecAXPY(difference, -1.0, b));
  PetscReal left = 0.0, all = 0.0;
  check(VecNorm(difference, NORM_2, &left));
  check(VecNorm(b, NORM_2, &all));
  return left / all;
}

TEST(BeamPreconditioner, SolvesInOneApplication) {
  const Handle<Mat> matrix = beam_matrix(1.0, true);
  const Handle<KSP> ksp = solver(matrix);
  EXPECT_LT(residual(ksp, matrix), 1e-13);
}

TEST(BeamPreconditioner, FactorsAgainWhenTheMatrixChanges) {
  const Handle<Mat> matrix = beam_matrix(1.0, true);
  const Handle<KSP> ksp = solver(matrix);
  EXPECT_LT(residual(ksp, matrix), 1e-13);
  check(MatShift(matrix, 1e9));  // as a TS does with a new shift
  EXPECT_LT(residual(ksp, matrix), 1e-13);
}

TEST(BeamPreconditioner, ErrorsComeOutOfTheSolve) {
  const Handle<Mat> negative = beam_matrix(-1.0, true);
  const Handle<KSP> ksp = solver(negative);
  EXPECT_THROW((void)residual(ksp, negative), SolverError);

  const Handle<Mat> wide = beam_matrix(1.0, true);
  PetscInt begin = 0;
  check(MatGetOwnershipRange(wide, &begin, nullptr));
  check(MatSetOption(wide, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_FALSE));
  if (begin == 0) check(MatSetValue(wide, 0, 7, 1.0, INSERT_VALUES));
  check(MatAssemblyBegin(wide, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(wide, MAT_FINAL_ASSEMBLY));
  const Handle<KSP> refused = solver(wide);
  EXPECT_THROW((void)residual(refused, wide), std::logic_error);
}

}  // namespace
