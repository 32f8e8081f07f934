// A passage of moving forces by modes where only the peaks at the probes are wanted: what a sweep is made of.
#pragma once

#include <functional>
#include <vector>

#include "integrate/modal_motion.hpp"

namespace traverse::integrate {

/// The largest magnitude of a response, and when.
struct Peak {
  double value = 0.0, time = 0.0;

  void note(double candidate, double at) {
    if (candidate > value) *this = {candidate, at};
  }
};
struct ProbePeaks {
  Peak deflection, acceleration, moment;  // m, m/s2, N m
};

/// The peaks from t = 0 to end_time at every probe of the bridge, looked for at instants a twentieth of the shortest
/// period apart, wherever a force passes a node or a probe, and between them by parabolas. `going` is asked now and
/// then; once it returns false the search stops, and there are no peaks.
std::vector<ProbePeaks> modal_peaks(const structure::ModalBridge& bridge, const ForceHistory& history, double speed,
                                    bool equilibrium, double end_time, const std::function<bool()>& going);

/// The largest static deflection of each probe while the forces pass, m.
std::vector<double> static_peaks(const structure::ModalBridge& bridge, const ForceHistory& history);

}  // namespace traverse::integrate
