// The part of a moving force that changes over time: a Fourier series of one frequency, a table, or both.
#pragma once

#include <optional>
#include <vector>

#include "traverse/base/time_function.hpp"

namespace traverse::train {

/// sum_k amplitude_k sin(2 pi k f t + phase_k) + table(t), added to the constant part of each force (N) or line load
/// (N/m) of a group; positive downward.
struct ForceVariation {
  double frequency = 0.0;                   // f, Hz
  std::vector<double> amplitudes;           // amplitudes of the harmonics k = 1, 2, ..., N or N/m
  std::vector<double> phases;               // rad, one for each amplitude
  std::optional<base::TimeFunction> table;  // piecewise linear

  /// Whether the force varies.
  bool varies() const { return table || !amplitudes.empty(); }
  /// The value at t (s), N or N/m.
  double at(double t) const;
  /// The frequency of the highest harmonic with an amplitude, Hz; 0 without harmonics.
  double highest_frequency() const;
  /// Times at which the rate of the force jumps.
  std::vector<double> kinks() const { return table ? table->kinks() : std::vector<double>(); }
};

}  // namespace traverse::train
