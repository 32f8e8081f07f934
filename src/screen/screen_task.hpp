// A formation over a bridge at a group of speeds, as plain arrays: the whole interface between the kernel and the other
// parts of the program.
#pragma once

namespace traverse::screen {

struct ScreenTask {
  int width = 8;  // lanes
  int modes = 0, supports = 0, numbers_of_mode = 0;
  const double* numbers = nullptr;  // of the group of speeds: BridgeModel::numbers
  const double* speed = nullptr;    // m/s, lanes
  const double* limit = nullptr;    // lanes: the fraction of the limits below which a lane is of no interest
  // For each mode: beta, omega^2, real and imaginary part of lambda^2, ModeOfBridge::size.
  const double *beta = nullptr, *omega2 = nullptr, *lambda2 = nullptr, *size = nullptr;

  long events = 0;
  const double *load = nullptr, *length = nullptr, *sums = nullptr;  // TrainEvents
  const int *support = nullptr, *gap = nullptr;
  int gaps = 0;
  const double* gap_length = nullptr;
  bool continuous = false;  // there are exponential parts

  int stations = 0, different_parts = 0;
  const double *shapes = nullptr, *of_deflection = nullptr;      // [station][mode], [station]
  const double *magnitudes = nullptr, *of_magnitudes = nullptr;  // of different parts
  const double* largest = nullptr;                               // of each mode
  double of_acceleration = 0.0, largest_of_deflection = 0.0;
  double part = 0.0;  // m: between stations

  // Passages only.
  double spacing = 0.0, tail = 0.0;  // m: between samples; part of the free oscillation behind the train
  bool every = false;                // every interval is sampled, also where the bound is below all interest
  bool search = false;               // searches for peaks between samples and stations, after a call that has sampled
  /// The exact largest fraction of a limit in an interval of one lane. z: Z of each mode at its start, real and
  /// imaginary part; length: m; samples: parts of the interval. `least` if that is greater.
  double (*search_peak)(void* context, int lane, long event, const double* z, double length, int samples, double error,
                        double least) = nullptr;
  void* context = nullptr;

  double* result = nullptr;  // lanes: the bound, or the largest fraction of a limit
  long* sampled = nullptr;   // number of sampled intervals
  double* work = nullptr;    // work_size() numbers, aligned as a lane
};

}  // namespace traverse::screen
