// The lowest modes of one segment by SLEPc, with shift and invert next to the lowest frequency, and PETSc vectors of
// one rank for the eigensolvers.
#pragma once

#include <vector>

#include "base/petsc.hpp"
#include "segment.hpp"

namespace traverse::modes {

base::Handle<Vec> vector(const std::vector<double>& values);

/// A reproducible start vector, orthogonal to hardly any mode: values in (-1, 1) by a linear congruential generator.
std::vector<double> start_vector(int size, unsigned seed);

struct Eigenpair {
  double omega = 0.0;         // rad/s
  std::vector<double> shape;  // for each unknown of the segment
};

/// The `count` lowest modes of the segment, including rigid ones, ascending, with all copies of a repeated frequency.
/// Needs no communication and has the same bits on each rank. Throws SolverError.
std::vector<Eigenpair> lowest_modes(const Segment& segment, int count);

}  // namespace traverse::modes
