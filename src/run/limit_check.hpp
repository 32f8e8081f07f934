// Evaluates the quantities of all limits from a run and compares them with the limits. Rotations of the deck and
// accelerations of cars are evaluated for limits only.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/extremum.hpp"
#include "beam/beam.hpp"
#include "results/verdict.hpp"
#include "run/response_extremes.hpp"
#include "train/fleet.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

using base::Extreme;

/// Rotations of the deck at the two ends of the bridge, and the relative rotations of decks at a joint or a hinge over
/// a support.
class DeckRotations {
 public:
  explicit DeckRotations(const beam::Beam& beam);
  /// Collective. v: this rank's displacements.
  void add(double t, const double* v);
  /// Records given rotations, rad, in the order of unknowns().
  void record(double t, std::span<const double> slopes) {
    for (std::size_t i = 0; i < 2; ++i) ends_.raise(std::abs(slopes[i]), t, i);
    for (std::size_t i = 0; i < x_.size(); ++i) joints_.raise(std::abs(slopes[2 * i + 3] - slopes[2 * i + 2]), t, i);
  }
  /// The unknowns of the ends, then the unknowns of the left and right side of each joint.
  const std::vector<int>& unknowns() const { return unknowns_; }

  // Magnitudes, rad; below 0: none.
  const Extreme& at_ends() const { return ends_; }      // place: 0 left, 1 right
  const Extreme& at_joints() const { return joints_; }  // place: index in joints()
  const std::vector<double>& joints() const { return x_; }
  void keep(base::Bytes& bytes) { bytes(ends_, joints_); }

 private:
  const beam::Beam& beam_;
  std::vector<int> unknowns_;
  std::vector<double> slopes_;  // rad, of unknowns_
  std::vector<double> x_;       // m, of the joints
  Extreme ends_{-1.0}, joints_{-1.0};
};

/// Vertical accelerations of the heaviest body of each vehicle.
class CarAccelerations {
 public:
  explicit CarAccelerations(const train::Fleet& fleet);
  void add(double t);

  /// m/s2; place: the vehicle; value below 0: no vehicle.
  const Extreme& largest() const { return largest_; }
  const std::string& body(std::size_t vehicle) const;
  void keep(base::Bytes& bytes) { bytes(largest_); }

 private:
  const train::Fleet& fleet_;
  std::vector<std::size_t> heaviest_;  // index in each vehicle's bodies
  Extreme largest_{-1.0};
};

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
