// The least and the greatest normal force of all wheels, and the largest part of its force at the start that one loses,
// looked for at every step and between steps as turn.hpp has it.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/bytes.hpp"
#include "run/turn.hpp"

namespace traverse::app {

class WheelExtremes {
 public:
  WheelExtremes() = default;
  /// kinks: ascending stations at which the track or the bridge has a corner, so that a force over time has a kink.
  WheelExtremes(std::size_t wheels, std::vector<double> kinks);

  /// The next instant of a wheel whose centre is at x.
  void add(std::size_t wheel, double t, double x, double force);
  /// After the last one.
  void finish();

  /// N, of a wheel in the order of the fleet; infinite: none has been seen.
  const Extreme& least() const { return least_; }
  const Extreme& greatest() const { return greatest_; }
  /// Over the force at the start; below 0: none has been seen.
  const Extreme& unloading() const { return unloading_; }
  void keep(base::Bytes& bytes) { bytes(seen_, at_start_, least_, greatest_, unloading_); }

 private:
  /// The latest instants of a wheel.
  struct Seen {
    Samples force;
    std::array<double, Samples::most> x{};
  };
  void note(double force, double time, std::size_t wheel);
  /// If the instant i is extreme.
  void look(const Seen& seen, std::size_t i, std::size_t wheel);
  /// Whether there is neither flight nor a corner from instant i to j.
  bool smooth(const Seen& seen, std::size_t i, std::size_t j) const;

  std::vector<Seen> seen_;
  std::vector<double> at_start_;  // N, of every wheel
  std::vector<double> kinks_;
  Extreme least_{std::numeric_limits<double>::infinity()}, greatest_{-std::numeric_limits<double>::infinity()};
  Extreme unloading_{-1.0};
};

}  // namespace traverse::app
