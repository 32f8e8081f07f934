// Static solutions K* v = P of a beam with its loads, for tests on any number of ranks.
#pragma once

#include <petscksp.h>

#include <vector>

#include "beam/beam.hpp"
#include "beam/shape.hpp"
#include "recovery/recovery.hpp"

namespace traverse::test {

/// Adds a concentrated load at x to this rank's nodal forces (eq. 13), and returns it as an element load.
inline recovery::ElementLoad add_load(const beam::Beam& b, double x, double fy, double moment, double fx, double* P) {
  const beam::Station at = b.mesh().locate(x);
  const beam::Element& e = b.mesh().element(at.element);
  const auto psi = beam::hermite(at.xi, e.length, e.shear).value, turn = beam::rotation(at.xi, e.length, e.shear);
  const auto phi = beam::linear(at.xi);
  const auto add = [&](int unknown, double value) {
    const int local = unknown < 0 ? -1 : b.local(unknown);
    if (local >= 0) P[local] += value;
  };
  for (int i = 0; i < 2; ++i) add(b.bridge().axial(at.element)[i], fx * phi[i]);
  for (int i = 0; i < 4; ++i) add(b.bridge().transverse(at.element)[i], fy * psi[i] + moment * turn[i]);
  return {at.element, at.xi, fx, fy, moment};
}

/// Solves A x = f for the unknowns that no support holds; the others are zero.
inline std::vector<double> solve_free(const beam::Beam& b, Mat A, const std::vector<double>& f) {
  using base::check;
  PetscInt start = 0;
  check(MatGetOwnershipRange(A, &start, nullptr));
  std::vector<PetscInt> free;
  std::vector<double> right;
  for (int i = 0; i < b.local_unknowns(); ++i) {
    if (b.fixed()[i]) continue;
    free.push_back(start + i);
    right.push_back(f[i]);
  }
  base::Handle<IS> rows;
  base::Handle<Mat> K;
  base::Handle<Vec> x, y;
  base::Handle<KSP> ksp;
  check(ISCreateGeneral(b.comm(), static_cast<PetscInt>(free.size()), free.data(), PETSC_COPY_VALUES, rows.out()));
  check(MatCreateSubMatrix(A, rows, rows, MAT_INITIAL_MATRIX, K.out()));
  check(MatCreateVecs(K, x.out(), y.out()));
  PetscScalar* values = nullptr;
  check(VecGetArray(y, &values));
  std::copy(right.begin(), right.end(), values);
  check(VecRestoreArray(y, &values));
  PC pc = nullptr;
  check(KSPCreate(b.comm(), ksp.out()));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPSetOperators(ksp, K, K));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCREDUNDANT));  // LU of the whole matrix on every rank
  check(KSPSolve(ksp, y, x));
  std::vector<double> solution(f.size(), 0.0);
  check(VecGetArray(x, &values));
  for (std::size_t i = 0; i < free.size(); ++i) solution[free[i] - start] = values[i];
  check(VecRestoreArray(x, &values));
  return solution;
}

/// Static displacements under the nodal forces P.
inline std::vector<double> static_solution(const beam::Beam& b, const std::vector<double>& P) {
  return solve_free(b, b.stiffness(), P);
}

}  // namespace traverse::test
