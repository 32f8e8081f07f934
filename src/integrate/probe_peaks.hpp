// What a run of a sweep leaves of each probe's responses.
#pragma once

namespace traverse::integrate {

/// The largest magnitude of a response, and when.
struct Peak {
  double value = 0.0, time = 0.0;
};
struct ProbePeaks {
  Peak deflection, acceleration, moment;  // m, m/s2, N m
};

}  // namespace traverse::integrate
