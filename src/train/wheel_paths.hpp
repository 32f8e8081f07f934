// Where the wheels of a train have been, for statics along the way: vehicles that meet or follow each other at
// different speeds are never all over one place at the distances they start with.
#pragma once

#include <cstddef>
#include <vector>

#include "base/bytes.hpp"

namespace traverse::train {

class Fleet;

class WheelPaths {
 public:
  /// The next instant; the fleet complete on this rank. Keeps some thousand of them, evenly spread.
  void add(double t, const Fleet& fleet);

  std::size_t instants() const { return time_.size(); }
  double time(std::size_t instant) const { return time_[instant]; }
  /// x of a contact of the fleet's wheels, m.
  double x(std::size_t instant, std::size_t wheel) const { return x_[instant * wheels_ + wheel]; }
  /// The most that the distance of a wheel from the first one has changed by, m.
  double drift() const { return drift_; }
  void keep(base::Bytes& bytes) { bytes(wheels_, time_, x_, stride_, seen_, drift_); }

 private:
  void thin_out();

  std::size_t wheels_ = 0;
  std::vector<double> time_, x_;  // x: [instant][wheel]
  std::size_t stride_ = 1, seen_ = 0;
  double drift_ = 0.0;
};

}  // namespace traverse::train
