// Access to the entries of PETSc vectors within a scope.
#pragma once

#include "base/petsc.hpp"

namespace traverse::integrate {

struct Array {  // writable
  explicit Array(Vec v) : vec(v) { base::check(VecGetArray(v, &data)); }
  ~Array() { (void)VecRestoreArray(vec, &data); }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  Vec vec;
  double* data = nullptr;
};

struct ReadArray {
  explicit ReadArray(Vec v) : vec(v) { base::check(VecGetArrayRead(v, &data)); }
  ~ReadArray() { (void)VecRestoreArrayRead(vec, &data); }
  ReadArray(const ReadArray&) = delete;
  ReadArray& operator=(const ReadArray&) = delete;
  Vec vec;
  const double* data = nullptr;
};

}  // namespace traverse::integrate
