// Evaluates limited quantities of moving forces by modes that are exact in time, where peaks are not sufficient:
// filtered accelerations, rotations and the twist. The accelerations of the probes are filtered, or the accelerations
// of the modes if there are fewer modes.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "base/passage_peaks.hpp"
#include "integrate/force_history.hpp"
#include "results/verdict.hpp"
#include "run/limit_check.hpp"
#include "run/plan.hpp"
#include "run/response_extremes.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::ensemble {

class MovingForceLimits {
 public:
  /// The scene's dampers must not couple modes. cutoff_frequency: Hz, of accelerations; 0: they are not filtered. Scene
  /// and beam must outlive this object.
  MovingForceLimits(const scene::Scene& scene, run::SharedBeam& shared, double cutoff_frequency);

  /// The quantity of each limit of the scene with its present speed and force train number `train`. peaks,
  /// static_deflection (m): at each probe.
  std::vector<results::EvaluatedQuantity> evaluate(std::size_t train, double end_time,
                                                   std::span<const base::ProbePeaks> peaks,
                                                   std::span<const double> static_deflection);

 private:
  void sample_run(std::size_t train, const run::Plan& plan, run::LimitCheck& check);
  results::LowPassed filtered(double interval);
  base::Extreme largest_at_probes(double interval);
  /// Converts the modes' accelerations to the accelerations of the probes.
  void at_probes(const double* of_modes, double* row) const;

  const scene::Scene& scene_;
  const run::SharedBeam& shared_;
  double cutoff_frequency_;
  bool by_modes_;          // the modes' accelerations are filtered, because there are fewer modes than probes
  std::size_t count_;      // number of filtered series
  bool rotates_;           // a rotation has a limit
  bool twists_;            // the twist of a track has a limit
  std::size_t rotations_;  // number of slopes that are rotations; the others are rates of the twist
  train::Fleet no_fleet_;
  structure::ModalSlopes slopes_;
  std::map<std::size_t, integrate::ForceHistory> histories_;  // the key is the train
  std::vector<double> series_, rows_;  // accelerations at every instant; accelerations of the probes
  std::vector<double> bounds_;         // of the accelerations of all probes at every instant
};

}  // namespace traverse::ensemble
