// How far the peaks of two runs of the same passage differ.
#pragma once

#include <array>

#include "base/passage_peaks.hpp"
#include "run/quantity.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Of each quantity's peaks, relative.
using PeakErrors = std::array<double, quantities>;

/// The largest difference at any probe of each quantity that the scene's accuracy is asked of, over the largest peak of
/// its kind in `fine`; of others 0.
PeakErrors difference(const Scene& scene, const base::PassagePeaks& rough, const base::PassagePeaks& fine);
double greatest(const PeakErrors& errors);

}  // namespace traverse::app
