// Differences of the peaks of two runs of the same train at the same speed.
#pragma once

#include <array>

#include "base/passage_peaks.hpp"
#include "run/response_extremes.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// Relative error of each quantity's peaks.
using PeakErrors = std::array<double, run::quantities>;

/// For each controlled quantity the largest difference at any probe, relative to the largest peak in `fine`; 0 for
/// other quantities.
PeakErrors difference(const scene::Scene& scene, const base::PassagePeaks& rough, const base::PassagePeaks& fine);

}  // namespace traverse::error_control
