// PETSc vectors of one rank for the eigensolvers.
#pragma once

#include <vector>

#include "base/petsc.hpp"

namespace traverse::modes {

base::Handle<Vec> vector(const std::vector<double>& values);

/// A reproducible start vector, orthogonal to hardly any mode: values in (-1, 1) by a linear congruential generator.
std::vector<double> start_vector(int size, unsigned seed);

}  // namespace traverse::modes
