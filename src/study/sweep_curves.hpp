// What a sweep found, as curves over the speed.
#pragma once

#include <vector>

#include "results/sweep.hpp"
#include "study/speed_refinement.hpp"

namespace traverse::app {

/// Of every train: its peaks at the worst probe, its greatest wheel force and what limits are of, but for losses of
/// contact, which are no smooth curve.
std::vector<SpeedCurve> curves_of(const results::Sweep& sweep);

/// Of every train the quantities whose limits no run has broken so far.
std::vector<LimitedCurve> curves_in_doubt(const results::Sweep& sweep);

/// values [trains][speeds][probes]: at every speed the largest of one train.
std::vector<double> worst_of_probes(const results::Sweep& sweep, const std::vector<double>& values, std::size_t train);

}  // namespace traverse::app
