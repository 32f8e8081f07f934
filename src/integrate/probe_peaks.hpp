// What a run of a sweep leaves of each probe's responses.
#pragma once

#include "base/extremum.hpp"

namespace traverse::integrate {

/// Magnitudes.
struct ProbePeaks {
  base::Extreme deflection, acceleration, moment;  // m, m/s2, N m
};

}  // namespace traverse::integrate
