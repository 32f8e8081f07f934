// What limits ask of passages of moving forces by modes that are exact in time, where peaks alone are not enough:
// filtered accelerations and rotations. The probes' accelerations are filtered, or those of the modes where there are
// fewer of these.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "base/passage_peaks.hpp"
#include "integrate/force_history.hpp"
#include "results/verdict.hpp"
#include "run/limit_check.hpp"
#include "run/plan.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

class MovingForceLimits {
 public:
  /// Of a scene whose dampers couple no modes. counting: Hz, up to which accelerations count; 0: they are not filtered.
  /// Both must outlive it.
  MovingForceLimits(const Scene& scene, SharedBeam& shared, double counting);

  /// One for each limit of the scene as it is now, with its train of forces, which is number `train`, and its speed.
  /// peaks, static_deflection (m): of each probe.
  std::vector<results::EvaluatedQuantity> of(std::size_t train, double end_time,
                                             std::span<const base::ProbePeaks> peaks,
                                             std::span<const double> static_deflection);

 private:
  void pass(std::size_t train, const Plan& plan, LimitCheck& judge);
  results::LowPassed filtered(double interval);
  /// From the modes' accelerations to those of the probes.
  void at_probes(const double* of_modes, double* row) const;

  const Scene& scene_;
  const SharedBeam& shared_;
  double counting_;
  bool by_modes_;      // the modes' accelerations are filtered, not the probes', as there are fewer of them
  std::size_t count_;  // of either
  train::Fleet no_fleet_;
  structure::ModalSlopes slopes_;
  std::map<std::size_t, integrate::ForceHistory> histories_;  // of each train
  std::vector<double> series_, rows_;                         // accelerations at every instant, those of the probes
};

}  // namespace traverse::app
