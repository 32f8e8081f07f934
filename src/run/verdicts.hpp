// From the extremes of a run to a verdict on each limit.
#pragma once

#include <optional>
#include <vector>

#include "results/verdict.hpp"
#include "run/judged_motion.hpp"
#include "run/peaks.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// What a run is watched for where there are limits. Scene, fleet and beam must outlive it.
class Judge {
 public:
  /// beam: null where there is none.
  Judge(const Scene& scene, const train::Fleet& fleet, const beam::Beam* beam);

  /// Collective. An observed instant; v: this rank's displacements of the structure.
  void sample(double t, const double* v);
  /// The end of a step, of the wheels in the order of the fleet.
  void wheel(std::size_t wheel, double t, double force) { unloading_.add(wheel, t, force); }

  /// After the last instant.
  std::vector<results::Verdict> verdicts(const results::Summary& summary, const Peaks& peaks) const;

 private:
  friend struct Findings;

  const Scene& scene_;
  const train::Fleet& fleet_;
  std::optional<DeckRotations> rotations_;
  CarAccelerations cars_;
  WheelUnloading unloading_;
};

}  // namespace traverse::app
