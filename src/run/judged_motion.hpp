// Extremes that only limits ask for: rotations of the deck, accelerations of cars.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "beam/beam.hpp"
#include "train/fleet.hpp"

namespace traverse::app {

/// The largest magnitude that has been seen of something, when, and of which one.
struct Largest {
  double value = -1.0;  // below 0: nothing has been seen
  double time = 0.0;    // s
  std::size_t which = 0;

  bool known() const { return value >= 0.0; }
  void note(double magnitude, double t, std::size_t one) {
    if (magnitude > value) *this = {magnitude, t, one};
  }
};

/// Rotations of the deck at the two ends of the bridge, and between decks that meet at a joint or a hinge over a
/// support.
class DeckRotations {
 public:
  explicit DeckRotations(const beam::Beam& beam);
  /// Collective. v: this rank's displacements.
  void add(double t, const double* v);
  /// The same from rotations that are known, rad, in the order of unknowns().
  void note(double t, std::span<const double> slopes) {
    for (std::size_t i = 0; i < 2; ++i) ends_.note(std::abs(slopes[i]), t, i);
    for (std::size_t i = 0; i < x_.size(); ++i) joints_.note(std::abs(slopes[2 * i + 3] - slopes[2 * i + 2]), t, i);
  }
  /// Of the ends, then of the left and right side of each joint.
  const std::vector<int>& unknowns() const { return unknowns_; }

  const Largest& at_ends() const { return ends_; }      // which: 0 left, 1 right
  const Largest& at_joints() const { return joints_; }  // which: of joints()
  const std::vector<double>& joints() const { return x_; }
  void keep(base::Bytes& bytes) { bytes(ends_, joints_); }

 private:
  const beam::Beam& beam_;
  std::vector<int> unknowns_;
  std::vector<double> slopes_;  // rad, of these
  std::vector<double> x_;       // m
  Largest ends_, joints_;
};

/// Vertical accelerations of the heaviest body of each vehicle.
class CarAccelerations {
 public:
  explicit CarAccelerations(const train::Fleet& fleet);
  void add(double t);

  const Largest& largest() const { return largest_; }  // which: the vehicle
  const std::string& body(std::size_t vehicle) const;
  void keep(base::Bytes& bytes) { bytes(largest_); }

 private:
  const train::Fleet& fleet_;
  std::vector<std::size_t> heaviest_;  // of each vehicle's own bodies
  Largest largest_;
};

}  // namespace traverse::app
