// The peaks of a sweep: in the file under /sweep, and as a table on the terminal.
#pragma once

#include <limits>
#include <vector>

#include "traverse/results/recorder.hpp"

namespace traverse::results {

struct Sweep {
  static constexpr double not_run = std::numeric_limits<double>::quiet_NaN();

  std::vector<double> speed;   // m/s
  std::vector<int> trains;     // numbers of HSLM-A; empty: one train, whatever it is
  std::vector<double> probes;  // stations, m
  /// Magnitudes [trains][speeds][probes] and when they occurred; not_run where no run got to its end.
  struct Peaks {
    std::vector<double> value, time;
  };
  Peaks deflection, acceleration, moment;  // m, m/s2, N m
  std::vector<double> amplification;       // of the deflection over that at rest
  std::vector<double> least_wheel_force;   // [trains][speeds], N; empty without vehicles

  std::size_t rows() const { return trains.empty() ? 1 : trains.size(); }
};

/// Writes it under /sweep.
void record(const Sweep& sweep, Recorder& recorder);
/// The largest of all runs, for /summary.
Summary extremes(const Sweep& sweep);
/// Peaks of each train over all speeds and probes, and the speeds that they belong to.
void print_sweep(const Sweep& sweep);

}  // namespace traverse::results
