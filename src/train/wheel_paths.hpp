// The paths of a train's wheels, for static deflections during the run: vehicles that pass or follow each other at
// different speeds do not keep their initial distances.
#pragma once

#include <cstddef>
#include <vector>

#include "base/bytes.hpp"

namespace traverse::train {

class Fleet;

class WheelPaths {
 public:
  /// Adds the next instant; the fleet must be complete on this rank. At most some thousand instants are stored, evenly
  /// spaced.
  void add(double t, const Fleet& fleet);

  std::size_t instants() const { return time_.size(); }
  double time(std::size_t instant) const { return time_[instant]; }
  /// x of a contact of the fleet's wheels, m.
  double x(std::size_t instant, std::size_t wheel) const { return x_[instant * wheels_ + wheel]; }
  /// The largest change of the distance between a wheel and the first wheel, m.
  double drift() const { return drift_; }
  void keep(base::Bytes& bytes) { bytes(wheels_, time_, x_, stride_, count_, drift_); }

 private:
  void thin_out();

  std::size_t wheels_ = 0;
  std::vector<double> time_, x_;  // x: [instant][wheel]
  std::size_t stride_ = 1, count_ = 0;
  double drift_ = 0.0;
};

}  // namespace traverse::train
