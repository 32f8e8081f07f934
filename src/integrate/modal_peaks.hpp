// The peaks of a passage of moving forces by modes where dampers couple these or the ones left out: other passages go
// side by side (modal_engine/moving_force_batch.hpp).
#pragma once

#include <functional>
#include <vector>

#include "base/passage_peaks.hpp"
#include "integrate/modal_motion.hpp"

namespace traverse::integrate {

/// The peaks from t = 0 to end_time (s) at every probe of the bridge, looked for at so many `instants` a period of the
/// fastest mode, wherever a force passes a node or a probe, and between them by parabolas. `going` is asked now and
/// then; once it returns false the search stops, and there are no peaks.
std::vector<base::ProbePeaks> modal_peaks(const structure::ModalBridge& bridge, const ForceHistory& history,
                                          double speed, bool equilibrium, double end_time, double instants,
                                          const std::function<bool()>& going);

}  // namespace traverse::integrate
