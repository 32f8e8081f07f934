// The greatest peaks of many runs of moving forces, of which only those are computed that may have one.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/passage_peaks.hpp"
#include "modal_engine/moving_force_batch.hpp"

namespace traverse::modal_engine {

/// A run of one of several trains.
struct ForceRun {
  std::size_t train = 0;
  double speed = 0.0, end = 0.0;  // m/s, s
};

/// The greatest peaks of the runs of each train at each probe. Peaks are NaN if they are not the greatest of all runs;
/// the greatest of all trains, and the greatest ratios of deflections to the static ones, are those of all runs. They
/// do not depend on the order of the runs. samples: in a period of the fastest mode; width: runs in a batch, at most
/// `engine::widest`. Empty if `proceed` returned false.
std::vector<std::vector<base::ProbePeaks>> greatest_peaks(const std::vector<const MovingForcePassages*>& trains,
                                                          std::span<const ForceRun> runs, double samples,
                                                          std::size_t width, const std::function<bool()>& proceed);

}  // namespace traverse::modal_engine
