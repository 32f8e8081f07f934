// Extremes that only limits ask for: rotations of the deck, accelerations of cars, forces that wheels lose.
#pragma once

#include <cstddef>
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

  const Largest& at_ends() const { return ends_; }      // which: 0 left, 1 right
  const Largest& at_joints() const { return joints_; }  // which: of joints()
  const std::vector<double>& joints() const { return x_; }

 private:
  const beam::Beam& beam_;
  std::vector<int> unknowns_;   // of the ends, then of the left and right side of each joint
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

 private:
  const train::Fleet& fleet_;
  std::vector<std::size_t> heaviest_;  // of each vehicle's own bodies
  Largest largest_;
};

/// How much of its force at the start each wheel loses.
class WheelUnloading {
 public:
  explicit WheelUnloading(std::size_t wheels) : at_start_(wheels, 0.0) {}
  void add(std::size_t wheel, double t, double force);

  const Largest& largest() const { return largest_; }  // over the force at the start; which: the wheel

 private:
  std::vector<double> at_start_;  // N
  Largest largest_;
};

}  // namespace traverse::app
