// Speeds of resonance and of cancellation: in the file under /resonances and /cancellations, and on the terminal.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "results/recorder.hpp"

namespace traverse::results {

/// A frequency f of the bridge that a train's regular distance d meets at v = f d/i.
struct Resonance {
  std::size_t train = 0;    // index
  int mode = 1, order = 1;  // which of the distinct frequencies, from 1; i
  double frequency = 0.0;   // Hz
  double distance = 0.0;    // m
  double speed = 0.0;       // m/s, predicted
  double width = 0.0;       // m/s: so far beside it the first axle and the last are out of step by a whole swing
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double of_deflection = none, of_acceleration = none;  // m/s, of the peaks that the sweep has there
};

/// A speed at which a force leaves a simple span without motion in one mode.
struct Cancellation {
  int mode = 1, half_waves = 3;  // n; of the mode's swing while the force crosses: n + 2 k
  double speed = 0.0;            // m/s
};

/// trains: numbers of HSLM-A; empty: one train, whatever it is.
void record(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
            const std::vector<Cancellation>& cancellations, Recorder& recorder);
/// One line for each resonance of the first frequency and for those of others at which the sweep has a peak, and one
/// for the cancellations of the first mode.
void print(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
           const std::vector<Cancellation>& cancellations);

}  // namespace traverse::results
