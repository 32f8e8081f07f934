// Sequential PETSc vectors from arrays, and a reproducible pseudo-random start vector for the eigensolvers.
#include "vectors.hpp"

#include <algorithm>
#include <cstdint>

namespace traverse::modes {

using base::check;

base::Handle<Vec> vector(const std::vector<double>& values) {
  base::Handle<Vec> v;
  check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(values.size()), v.out()));
  PetscScalar* raw = nullptr;
  check(VecGetArray(v, &raw));
  std::copy(values.begin(), values.end(), raw);
  check(VecRestoreArray(v, &raw));
  return v;
}

std::vector<double> start_vector(int size, unsigned seed) {
  std::vector<double> values(static_cast<std::size_t>(size));
  std::uint64_t state = 0x9E3779B97F4A7C15ULL + seed;
  for (double& value : values) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    value = static_cast<double>(state >> 11) * 0x1p-52 - 1.0;
  }
  return values;
}

}  // namespace traverse::modes
