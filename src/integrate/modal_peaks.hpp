// The peaks of a run of moving forces by modes if dampers couple these modes with each other or with the neglected
// modes. All other runs are computed in batches (modal_engine/moving_force_batch.hpp).
#pragma once

#include <functional>
#include <vector>

#include "base/passage_peaks.hpp"
#include "integrate/modal_motion.hpp"

namespace traverse::integrate {

/// The peaks from t = 0 to end_time (s) at every probe of the bridge. The responses are sampled `instants` times in a
/// period of the fastest mode, and whenever a force passes a node or a probe; peaks between samples are interpolated by
/// parabolas. `proceed` is called at intervals; once it returns false the search stops, and there are no peaks.
std::vector<base::ProbePeaks> modal_peaks(const structure::ModalBridge& bridge, const ForceHistory& history,
                                          double speed, bool equilibrium, double end_time, double instants,
                                          const std::function<bool()>& proceed);

}  // namespace traverse::integrate
