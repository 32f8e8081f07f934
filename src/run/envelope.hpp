// The least and the greatest response of every probe over a run: the envelopes along the bridge.
#pragma once

#include <vector>

#include "results/recorder.hpp"
#include "run/response_extremes.hpp"

namespace traverse::run {

/// /envelope/deflection, acceleration, moment, shear, each [p,2]: least and greatest, interpolated between samples;
/// each with _time (s). moment_shear and shear_moment: the shear, and the moment, at these instants. forces: whether
/// moments and shears are known.
std::vector<results::Recorder::Dataset> envelopes(const ResponseExtremes& peaks, bool forces);

}  // namespace traverse::run
