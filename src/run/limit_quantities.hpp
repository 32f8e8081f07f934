// Extremes that are evaluated for limits only: rotations of the deck, accelerations of cars.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/extremum.hpp"
#include "beam/beam.hpp"
#include "train/fleet.hpp"

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

}  // namespace traverse::run
