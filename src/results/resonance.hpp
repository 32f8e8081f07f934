// Resonance and cancellation speeds, stored under /resonances and /cancellations and printed on the terminal.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "results/recorder.hpp"

namespace traverse::results {

/// A resonance speed v = f d/i of the bridge's frequency f and a train's axle distance d.
struct Resonance {
  std::size_t train = 0;    // index
  int mode = 1, order = 1;  // number of the distinct frequency, from 1; i
  double frequency = 0.0;   // Hz
  double distance = 0.0;    // m
  double speed = 0.0;       // m/s, predicted
  double width = 0.0;       // m/s: change of speed by which the first and the last axle differ by one period
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double of_deflection = none, of_acceleration = none;  // m/s, speeds of the peaks of the sweep near this speed
};

/// A speed at which a force leaves no free vibration of one mode of a simple span.
struct Cancellation {
  int mode = 1, half_waves = 3;  // n; half waves of the mode's vibration while the force crosses: n + 2 k
  double speed = 0.0;            // m/s
};

/// trains: numbers of HSLM-A; empty: a single train.
void record(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
            const std::vector<Cancellation>& cancellations, Recorder& recorder);
/// One line for each train with the resonances of the first frequency, and one for the cancellations of the first mode.
void print(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
           const std::vector<Cancellation>& cancellations);

}  // namespace traverse::results
