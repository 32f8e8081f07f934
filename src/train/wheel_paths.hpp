// The paths of a train's wheels, for static deflections during the run: vehicles that pass or follow each other at
// different speeds do not keep their initial distances. Also whether a wheel or a moving force is on the line that it
// runs along.
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

/// Whether something at x with this speed is on the line from `start` to `end` (m). At an end it is only at rest: what
/// moves there has not arrived or has left.
inline bool is_on_line(double start, double end, double x, double speed) {
  if (speed == 0.0) return x >= start && x <= end;
  const double rounding = 1e-13 * (end - start);
  return x > start + rounding && x < end - rounding;
}

}  // namespace traverse::train
