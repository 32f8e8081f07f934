// A crossing by itself, step by step, by the kernel of the runs side by side (crossing_kernel.hpp).
#pragma once

#include <array>
#include <vector>

#include "base/bytes.hpp"
#include "lanes/crossing_numbers.hpp"

namespace traverse::lanes {

class SteppedCrossing {
 public:
  /// Of a plan the stretches do not count; its bridge must outlive the crossing. q: of the modes at t = 0; speed: m/s.
  SteppedCrossing(CrossingPlan plan, TrainNumbers train, TrackNumbers track, std::vector<double> q, double speed);
  SteppedCrossing(const SteppedCrossing&) = delete;
  SteppedCrossing& operator=(const SteppedCrossing&) = delete;

  /// A step until t; from_kink, to_kink: the surface may have a kink under a wheel where it begins or ends. Where there
  /// is trouble, all is as it was; but not_finite has no way back.
  Trouble step(double t, bool from_kink, bool to_kink);

  /// One number of what TaskInstant names, after the last step.
  using Numbers = const double* TaskInstant::*;
  double at(Numbers numbers, std::size_t i) const { return (now_.*numbers)[i]; }
  /// The state between two steps. FileError where another kind of processor has written it.
  void keep(base::Bytes& bytes);
  std::vector<double> bent() const;  // coordinates of every vehicle where it was farthest from linear

 private:
  CrossingPlan plan_;
  TrainNumbers train_;
  TrackNumbers track_;
  std::vector<double> q_;
  std::array<CrossingRun, 1> run_;
  CrossingNumbers numbers_;
  Task task_;
  engine::Aligned work_;
  TaskInstant now_;
};

}  // namespace traverse::lanes
