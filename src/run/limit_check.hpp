// Evaluates the quantities of all limits from a run and compares them with the limits.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "results/verdict.hpp"
#include "run/limit_quantities.hpp"
#include "run/response_extremes.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Records the quantities of limits during a run. Scene, fleet and beam must outlive this object.
class LimitCheck {
 public:
  /// beam: null without a bridge.
  LimitCheck(const scene::Scene& scene, const train::Fleet& fleet, const beam::Beam* beam);

  /// Collective. Evaluates an observed instant; v: this rank's displacements of the structure.
  void sample(double t, const double* v);
  /// Evaluates an instant at which only the rotations at the rotations' unknowns are known, rad.
  void rotations(double t, std::span<const double> slopes) { rotations_->record(t, slopes); }

  /// The verdicts, after the last instant. deflections: the largest deflection at each probe.
  std::vector<results::Verdict> verdicts(const results::Summary& summary, std::span<const Extreme> deflections) const;

  void keep(base::Bytes& bytes) {
    if (rotations_) rotations_->keep(bytes);
    cars_.keep(bytes);
  }

 private:
  friend struct Quantities;

  const scene::Scene& scene_;
  const train::Fleet& fleet_;
  std::optional<DeckRotations> rotations_;
  CarAccelerations cars_;
};

}  // namespace traverse::run
