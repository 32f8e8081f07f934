// Passages of moving forces by modes, exact in time, where only the peaks at the probes are wanted: what a sweep is
// made of. Runs of one train at several speeds go side by side, one in each lane of the processor's vectors.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/passage_peaks.hpp"
#include "integrate/force_history.hpp"
#include "modal_engine/moving_force_task.hpp"
#include "structure/modal_bridge.hpp"

namespace traverse::modal_engine {

/// One train of forces over one bridge.
class MovingForcePassages {
 public:
  /// The bridge must outlive it. equilibrium: runs start in static equilibrium under the forces that stand on the
  /// bridge then, otherwise undeflected.
  MovingForcePassages(const structure::ModalBridge& bridge, const train::MovingLoad& load, bool equilibrium);

  /// The peaks from t = 0 to `end_times` (s) at every probe of the bridge, of at most `engine::widest` runs with speeds
  /// of one class (speed_class.hpp): [run][probe]. Looked for at `instants` a period of the fastest mode or somewhat
  /// more, wherever a response has a kink, and between them by parabolas. `going` is asked now and then; once it
  /// returns false the search stops, and there are no peaks.
  std::vector<std::vector<base::ProbePeaks>> peaks(std::span<const double> speeds, std::span<const double> end_times,
                                                   double instants, const std::function<bool()>& going) const;

  const integrate::ForceHistory& history() const { return history_; }
  /// The largest static deflection of each probe while the forces pass, m.
  std::vector<double> static_peaks() const;

 private:
  void find_kinks();

  const structure::ModalBridge& bridge_;
  integrate::ForceHistory history_;
  std::vector<double> q_, omega2_, damping_, weight_;
  std::vector<ForceEvent> event_;
  std::vector<int> first_kink_, kink_;
};

}  // namespace traverse::modal_engine
