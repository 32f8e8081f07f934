// The limited quantities of runs in batches: from peaks, from rotations and accelerations of cars that are watched in
// each lane, and from accelerations and wheel forces at equal distances, which are filtered after the run.
#pragma once

#include <span>
#include <vector>

#include "ensemble/case_batch.hpp"
#include "results/verdict.hpp"
#include "run/limit_check.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::ensemble {

class BatchLimits {
 public:
  /// cutoff_frequency: Hz, of the deck's accelerations; 0: they are not filtered. Scene and batch must outlive this
  /// object.
  BatchLimits(const scene::Scene& scene, const CaseBatch& lanes, double cutoff_frequency);

  /// Steps at whose ends is stored what the filters need.
  CaseBatch::Steps steps() const;
  /// The quantity of each limit of the scene in a run with these steps, of which `static_deflection` (m) is known at
  /// each probe.
  std::vector<results::EvaluatedQuantity> evaluate(const LaneRun& run, const engine::BatchResult& result,
                                                   std::span<const double> static_deflection) const;

 private:
  const scene::Scene& scene_;
  const CaseBatch& lanes_;
  double cutoff_frequency_;
  bool filters_deck_, filters_wheels_;
};

}  // namespace traverse::ensemble
