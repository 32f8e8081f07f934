// From the extremes of a run to a verdict on each limit.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "results/verdict.hpp"
#include "run/limit_quantities.hpp"
#include "run/response_extremes.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// What a run is watched for where there are limits. Scene, fleet and beam must outlive it.
class LimitCheck {
 public:
  /// beam: null where there is none.
  LimitCheck(const Scene& scene, const train::Fleet& fleet, const beam::Beam* beam);

  /// Collective. An observed instant; v: this rank's displacements of the structure.
  void sample(double t, const double* v);
  /// The same where only rotations at the rotations' unknowns are known, rad.
  void rotations(double t, std::span<const double> slopes) { rotations_->note(t, slopes); }

  /// After the last instant. deflections: the largest one of each probe.
  std::vector<results::Verdict> verdicts(const results::Summary& summary, std::span<const Extreme> deflections) const;

  void keep(base::Bytes& bytes) {
    if (rotations_) rotations_->keep(bytes);
    cars_.keep(bytes);
  }

 private:
  friend struct Findings;

  const Scene& scene_;
  const train::Fleet& fleet_;
  std::optional<DeckRotations> rotations_;
  CarAccelerations cars_;
};

}  // namespace traverse::app
