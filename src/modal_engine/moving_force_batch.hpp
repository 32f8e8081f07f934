// Passages of moving forces by modes, exact in time, for sweeps, which need only the peaks at the probes. Runs of one
// train at several speeds are computed together, one in each SIMD lane.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "base/passage_peaks.hpp"
#include "integrate/force_history.hpp"
#include "modal_engine/force_bounds.hpp"
#include "modal_engine/moving_force_task.hpp"
#include "structure/modal_bridge.hpp"

namespace traverse::modal_engine {

/// The responses at a probe, in the order of ForceTask.
inline constexpr std::array responses = {&base::ProbePeaks::deflection, &base::ProbePeaks::acceleration,
                                         &base::ProbePeaks::moment};

/// One train of forces on one bridge.
class MovingForcePassages {
 public:
  /// The bridge must outlive this object. equilibrium: runs start in static equilibrium under the forces on the bridge
  /// at t = 0, otherwise undeflected.
  MovingForcePassages(const structure::ModalBridge& bridge, const train::MovingLoad& load, bool equilibrium);
  MovingForcePassages(const MovingForcePassages&) = delete;
  MovingForcePassages& operator=(const MovingForcePassages&) = delete;

  /// The peaks from t = 0 to `end_times` (s) at every probe of the bridge, for at most `engine::widest` runs with
  /// speeds of one class (speed_class.hpp): [run][probe]. The responses are sampled `samples_per_period` times or
  /// slightly more in a period of the fastest mode, and at their kinks, wherever their bound exceeds their peak so far;
  /// peaks between samples are interpolated by parabolas. `proceed` is called at intervals; once it returns false the
  /// search stops, and there are no peaks. least: for each probe, peaks that are not greater are not searched for and
  /// are NaN, if it is not below 0; empty: all peaks are searched for.
  std::vector<std::vector<base::ProbePeaks>> peaks(std::span<const double> speeds, std::span<const double> end_times,
                                                   double samples_per_period, const std::function<bool()>& proceed,
                                                   std::span<const base::ProbePeaks> least = {}) const;
  /// Numbers that the peaks of these runs do not exceed, in a small part of the time, for at most `engine::widest` runs
  /// with speeds of one octave: [run][probe].
  std::vector<std::vector<base::ProbePeaks>> bounds(std::span<const double> speeds, std::span<const double> end_times,
                                                    double samples_per_period,
                                                    const std::function<bool()>& proceed) const;

  const integrate::ForceHistory& history() const { return history_; }
  /// The largest static deflection at each probe during the passage of the forces, m.
  const std::vector<double>& static_peaks() const { return bounds_->static_peaks(); }

 private:
  void find_kinks(const Jumps& jumps);
  std::vector<std::vector<base::ProbePeaks>> run(std::span<const double> speeds, std::span<const double> end_times,
                                                 double samples_per_period, const std::function<bool()>& proceed,
                                                 std::span<const base::ProbePeaks> least, bool only_bounds) const;

  const structure::ModalBridge& bridge_;
  integrate::ForceHistory history_;
  std::vector<double> q_, omega2_, damping_, self_weight_;
  std::vector<char> all_kink_;  // 1 for each interval at whose start a modal force has a kink or a jump
  std::vector<int> first_kink_, kink_;
  std::unique_ptr<ForceBounds> bounds_;
  mutable std::map<double, ForceWindows> windows_;  // by their length, m; added when they are first needed
};

}  // namespace traverse::modal_engine
